// SPDX-License-Identifier: Apache-2.0
// Elements of an MJCF file with the defaults of their class, and numbers out of their attributes.
#pragma once

#include "engine/types/error.h"

#include <map>
#include <string>
#include <tinyxml2.h>
#include <vector>

namespace fathom {

// "FILE: line N" of an element that comes from an included file.
inline constexpr const char* kPlaceAttribute = "fathom_place";

// Where an element was written.
struct MjcfPlace {
    std::string file, line; // "line N"
};
MjcfPlace mjcfPlace(const tinyxml2::XMLElement& element, const std::string& mainFile);

// One file while it is read. Functions throw BadInput naming the element, the attribute and its value.
class MjcfClasses {
public:
    // Reads <default> elements of the root; file: for messages.
    MjcfClasses(const std::string& file, const tinyxml2::XMLElement& root);

    // An attribute of the element, else of its class (attribute `class`, else childClass), else of the
    // classes above that. Null when none states it. childClass: empty = the main class. A class states those
    // of all equalities in its <equality>.
    const char* find(const tinyxml2::XMLElement& element, const std::string& childClass,
                     const char* name) const;

    // Numbers of an attribute; `absent` when it is not stated. most: more numbers are refused. fills: where
    // there are fewer than `least`, those behind them are the class's, then those of the classes above.
    std::vector<double> numbers(const tinyxml2::XMLElement& element, const std::string& childClass,
                                const char* name, std::vector<double> absent, size_t least, size_t most,
                                bool fills = false) const;

    [[noreturn]] void refuse(const tinyxml2::XMLElement& element, const std::string& value,
                             const std::string& allowed) const;

private:
    struct Class {
        std::string above; // empty = the main class has none
        // By kind, in the order of the file.
        std::map<std::string, std::vector<const tinyxml2::XMLElement*>> elements;
    };
    void read(const tinyxml2::XMLElement& element, const std::string& above, bool main);
    std::vector<const char*> statedBy(const tinyxml2::XMLElement& element, const std::string& childClass,
                                      const char* name) const;

    std::string file_, main_;
    std::map<std::string, Class> classes_;
};

} // namespace fathom
