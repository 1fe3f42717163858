// SPDX-License-Identifier: Apache-2.0
#include "engine/reader/parser_text.h"

#include "engine/model/urdf_packet.h"
#include "engine/model/xml_text.h"
#include "engine/types/error.h"
#include "engine/types/printable.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>
#include <vector>

namespace fathom {

namespace {

// Stands for any inertial: only its presence counts.
constexpr std::string_view kInertial = "<inertial><mass value=\"1\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" "
                                       "iyy=\"1\" iyz=\"0\" izz=\"1\"/></inertial>";

void checkCapsule(const std::string& file, const std::string& link, std::string_view tag) {
    for (const char* size : {"radius", "length"}) {
        if (xmlAttribute(tag, size).empty()) {
            throw BadInput(file, "link " + printable(link), std::string("a capsule without ") + size,
                           "<capsule radius=\"r\" length=\"l\"/> [m], without its round ends");
        }
    }
}

// <capsule radius length/> becomes a mesh whose file name holds the sizes, which the parser passes on.
std::string hideCapsules(const std::string& file, const std::string& text) {
    std::string out, link;
    bool collides = false;
    for (XmlPieces pieces(text); pieces.next();) {
        const XmlPiece& piece = pieces.piece();
        link = piece.name == "link" && !piece.closes ? xmlAttribute(piece.text, "name") : link;
        collides = piece.name == "collision" ? !piece.closes : collides;
        if (piece.name == "capsule" && collides && !piece.closes) {
            checkCapsule(file, link, piece.text);
        }
        if (piece.name != "capsule") {
            out += piece.text;
        } else if (piece.closes) {
            out += "</mesh>";
        } else {
            out += "<mesh filename=\"" + std::string(kCapsuleFile) +
                   xmlEscaped(xmlAttribute(piece.text, "radius") + " " + xmlAttribute(piece.text, "length")) +
                   (piece.isEmpty ? "\"/>" : "\">");
        }
    }
    return out;
}

// Also of numbers that are too large for a double.
bool isInfinite(const std::string& value) {
    char* end = nullptr;
    const bool infinite = std::isinf(std::strtod(value.c_str(), &end));
    return infinite && std::string_view(end).find_first_not_of(" \t\r\n") == std::string_view::npos;
}

// A <limit> with 0 for what is not read or states nothing: an effort, an infinite or missing speed, infinite
// ends of a joint that needs none. joint: its <joint>.
std::string limitForParser(const std::string& file, std::string_view joint, std::string_view tag) {
    const std::string type = xmlAttribute(joint, "type");
    const bool needsEnds = type == "revolute" || type == "prismatic";
    std::string out, absent = " effort='0' velocity='0'";
    size_t copied = 0;
    for (const std::string_view name : xmlAttributeNames(tag)) {
        const std::string value = xmlAttribute(tag, name);
        const bool isEnd = name == "lower" || name == "upper", infinite = isInfinite(value);
        if (isEnd && infinite && needsEnds) {
            throw BadInput(file, "joint " + printable(xmlAttribute(joint, "name")),
                           "limit " + std::string(name) + "=\"" + excerpt(printable(value)) + "\"",
                           "finite numbers; type=\"continuous\" for a joint that turns without limits");
        }
        if (const size_t at = absent.find(std::string(" ").append(name).append("='"));
            at != std::string::npos) {
            absent.erase(at, name.size() + 5);
        }
        const size_t quote = tag.find_first_of("'\"", static_cast<size_t>(name.data() - tag.data()));
        if (name == "effort" || ((isEnd || name == "velocity") && infinite)) {
            out += std::string(tag.substr(copied, quote + 1 - copied)) + "0";
            copied = std::min(tag.find(tag[quote], quote + 1), tag.size());
        }
    }
    out += tag.substr(copied);
    return out.insert(std::string_view("<limit").size(), absent);
}

// Without materials, and without values of inertials and limits that are not read. A text whose tags do not
// match stays, for the parser to reject.
std::string withoutUnread(const std::string& text, const std::string& file) {
    std::string out;
    out.reserve(text.size());
    std::string_view joint;             // the last <joint> of the robot
    std::vector<std::string_view> open; // elements around the piece
    size_t inside = 0;                  // their number within the element that is left out; 0 = none is
    for (XmlPieces pieces(text); pieces.next();) {
        const XmlPiece& piece = pieces.piece();
        const bool tag = !piece.name.empty() && !piece.name.starts_with('!');
        const bool opens = tag && !piece.closes && !piece.isEmpty;
        if (tag && piece.closes) {
            if (open.empty() || open.back() != piece.name) {
                return text;
            }
            open.pop_back();
        }
        const bool unread = piece.name == "material" || piece.name == "inertial";
        if (inside == 0 && unread && !piece.closes) {
            inside = open.size() + 1;
            out += piece.name == "inertial" ? kInertial : "";
        }
        joint = opens && piece.name == "joint" && open.size() == 1 ? piece.text : joint;
        const bool limit = piece.name == "limit" && !piece.closes && open.size() == 2 && open[1] == "joint";
        if (inside == 0) {
            out += limit ? limitForParser(file, joint, piece.text) : std::string(piece.text);
        } else if (tag && !opens && open.size() < inside) {
            inside = 0;
        }
        if (opens) {
            open.push_back(piece.name);
        }
    }
    return out;
}

// A value without the spaces around it, if it is a number.
std::string_view trimmedNumber(std::string_view value) {
    constexpr std::string_view kSpaces = " \t\r\n";
    const size_t first = value.find_first_not_of(kSpaces);
    if (first == std::string_view::npos) {
        return value;
    }
    const std::string_view inner = value.substr(first, value.find_last_not_of(kSpaces) + 1 - first);
    return inner.find_first_not_of("0123456789+-.eE") == std::string_view::npos ? inner : value;
}

std::string normalisedTag(std::string_view tag) {
    std::string out;
    for (size_t open = 0; (open = tag.find_first_of("'\"")) != std::string_view::npos;) {
        const size_t close = tag.find(tag[open], open + 1);
        if (close == std::string_view::npos) {
            break;
        }
        out += tag.substr(0, open + 1);
        out += trimmedNumber(tag.substr(open + 1, close - open - 1));
        out += tag[close];
        tag.remove_prefix(close + 1);
    }
    out += tag;
    std::ranges::replace_if(
        out, [](char c) { return c == '\t' || c == '\r' || c == '\n'; }, ' ');
    return out;
}

} // namespace

std::string withNormalisedTags(const std::string& text) {
    std::string out;
    out.reserve(text.size());
    for (XmlPieces pieces(text); pieces.next();) {
        const XmlPiece& piece = pieces.piece();
        out += piece.name.empty() ? std::string(piece.text) : normalisedTag(piece.text);
    }
    return out;
}

std::string textForParser(const std::string& text, const std::string& file) {
    const std::string read = withoutUnread(text, file);
    return read.find("<capsule") == std::string::npos ? read : hideCapsules(file, read);
}

} // namespace fathom
