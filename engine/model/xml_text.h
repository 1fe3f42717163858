// SPDX-License-Identifier: Apache-2.0
// Walks the text of an XML file piece by piece, to change parts of it and keep the rest as it is. Malformed
// text gives pieces that mean nothing: a real parser accepts or rejects the file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace fathom {

// A tag, or the text up to the next one.
struct XmlPiece {
    std::string_view text;
    std::string_view name; // of a tag; empty for text, comments and declarations
    bool closes = false;   // </name>
    bool isEmpty = false;  // <name/>
};

// Splits a text into its pieces. `text` must outlive it.
class XmlPieces {
public:
    explicit XmlPieces(std::string_view text)
        : rest_(text) {}
    bool next(); // false at the end
    const XmlPiece& piece() const { return piece_; }

private:
    std::string_view rest_;
    XmlPiece piece_;
};

// The opening tags of a text, each with the elements it is in. `text` must outlive it.
class XmlTags {
public:
    explicit XmlTags(std::string_view text)
        : pieces_(text) {}
    bool next(); // false at the end
    const XmlPiece& tag() const { return pieces_.piece(); }
    // The elements around the tag, the outermost first: "robot/link".
    std::string_view path() const { return path_; }
    // The text behind the tag, up to the next one, without white space around it; entities are resolved.
    std::string content() const;

private:
    XmlPieces pieces_;
    std::string path_, opened_; // opened_: the tag, if it is not empty
};

// Names of a tag's attributes, in order.
std::vector<std::string_view> xmlAttributeNames(std::string_view tag);

// The value of an attribute of a tag, without its quotes; the five predefined entities are resolved. Empty =
// none.
std::string xmlAttribute(std::string_view tag, std::string_view name);

std::string xmlEscaped(std::string_view text); // for an attribute's value

} // namespace fathom
