// SPDX-License-Identifier: Apache-2.0
#include "engine/model/xml_text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

namespace fathom {

namespace {

constexpr std::array<std::pair<std::string_view, char>, 5> kEntities{
    {{"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}, {"&amp;", '&'}}};

// End of the tag that begins at 0, behind its '>'; quotes may hide one.
size_t tagEnd(std::string_view text) {
    char quote = 0;
    for (size_t i = 1; i < text.size(); ++i) {
        if (quote != 0) {
            quote = text[i] == quote ? '\0' : quote;
        } else if (text[i] == '"' || text[i] == '\'') {
            quote = text[i];
        } else if (text[i] == '>') {
            return i + 1;
        }
    }
    return text.size();
}

size_t behind(std::string_view text, std::string_view end) {
    const size_t at = text.find(end);
    return at == std::string_view::npos ? text.size() : at + end.size();
}

bool isSpace(char c) {
    return std::isspace(static_cast<unsigned char>(c)) != 0;
}

std::string resolved(std::string_view value) {
    std::string out;
    while (!value.empty()) {
        size_t used = 1;
        char c = value[0];
        for (const auto& [entity, meant] : kEntities) {
            if (value.starts_with(entity)) {
                used = entity.size();
                c = meant;
            }
        }
        out += c;
        value.remove_prefix(used);
    }
    return out;
}

} // namespace

bool XmlPieces::next() {
    if (rest_.empty()) {
        return false;
    }
    piece_ = {};
    size_t size = 0;
    if (rest_[0] != '<') {
        size = std::min(rest_.find('<'), rest_.size());
    } else if (rest_.starts_with("<!--")) {
        size = behind(rest_, "-->");
    } else if (rest_.starts_with("<![CDATA[")) {
        size = behind(rest_, "]]>");
    } else if (rest_.starts_with("<?")) {
        size = behind(rest_, "?>");
    } else {
        size = tagEnd(rest_);
        piece_.closes = rest_.starts_with("</");
        const std::string_view inside = rest_.substr(piece_.closes ? 2 : 1, size);
        piece_.name = inside.substr(0, std::min(inside.find_first_of(" \t\r\n/>"), inside.size()));
        piece_.isEmpty = size > 1 && rest_[size - 2] == '/';
    }
    piece_.text = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return true;
}

bool XmlTags::next() {
    if (!opened_.empty()) {
        path_ += (path_.empty() ? "" : "/") + opened_;
        opened_.clear();
    }
    while (pieces_.next()) {
        const XmlPiece& piece = pieces_.piece();
        if (piece.name.empty() || piece.name.starts_with('!')) {
            continue;
        }
        if (!piece.closes) {
            opened_ = piece.isEmpty ? "" : piece.name;
            return true;
        }
        const size_t last = path_.rfind('/');
        path_.resize(last == std::string::npos ? 0 : last);
    }
    return false;
}

std::string XmlTags::content() const {
    std::string out;
    XmlPieces ahead = pieces_;
    while (!tag().isEmpty && ahead.next() && ahead.piece().name.empty()) {
        const std::string_view text = ahead.piece().text;
        out += text.starts_with('<') ? "" : resolved(text); // not a comment
    }
    const auto last = std::find_if_not(out.rbegin(), out.rend(), isSpace).base();
    return {std::find_if_not(out.begin(), last, isSpace), last};
}

std::vector<std::string_view> xmlAttributeNames(std::string_view tag) {
    std::vector<std::string_view> names;
    size_t at = tag.find_first_of(" \t\r\n"); // behind the tag's own name
    while (at < tag.size() && (at = tag.find_first_not_of(" \t\r\n", at)) < tag.size()) {
        const size_t end = std::min(tag.find_first_of("= \t\r\n/>", at), tag.size());
        const size_t open = tag.find_first_of("'\"", end);
        if (end == at || open == std::string_view::npos) {
            break; // "/>"
        }
        names.push_back(tag.substr(at, end - at));
        const size_t close = tag.find(tag[open], open + 1);
        at = close == std::string_view::npos ? close : close + 1;
    }
    return names;
}

std::string xmlAttribute(std::string_view tag, std::string_view name) {
    char quote = 0;
    for (size_t i = 1; i < tag.size(); ++i) {
        if (quote != 0 || tag[i] == '"' || tag[i] == '\'') {
            quote = quote == 0 ? tag[i] : tag[i] == quote ? '\0' : quote;
            continue;
        }
        if (!isSpace(tag[i - 1]) || !tag.substr(i).starts_with(name)) {
            continue;
        }
        size_t at = i + name.size();
        while (at < tag.size() && isSpace(tag[at])) {
            ++at;
        }
        if (at >= tag.size() || tag[at] != '=') {
            continue;
        }
        const size_t open = tag.find_first_of("'\"", at);
        const size_t close = open == std::string_view::npos ? open : tag.find(tag[open], open + 1);
        return close == std::string_view::npos ? "" : resolved(tag.substr(open + 1, close - open - 1));
    }
    return "";
}

std::string xmlEscaped(std::string_view text) {
    std::string out;
    for (const char c : text) {
        std::string piece(1, c);
        for (const auto& [entity, meant] : kEntities) {
            piece = c == meant ? std::string(entity) : piece;
        }
        out += piece;
    }
    return out;
}

} // namespace fathom
