// SPDX-License-Identifier: Apache-2.0
#include "engine/reader/mjcf_class.h"

#include <cmath>
#include <cstdlib>
#include <sstream>
#include <string_view>

namespace fathom {

namespace {

constexpr const char* kMainClass = "main";

std::string attribute(const tinyxml2::XMLElement& element, const char* name) {
    const char* const text = element.Attribute(name);
    return text != nullptr ? text : "";
}

// The element of a class that states the defaults of the element.
const char* kindOf(const tinyxml2::XMLElement& element) {
    const tinyxml2::XMLElement* const holder = element.Parent()->ToElement();
    const bool equality = holder != nullptr && std::string_view(holder->Name()) == "equality";
    return equality ? holder->Name() : element.Name();
}

} // namespace

MjcfPlace mjcfPlace(const tinyxml2::XMLElement& element, const std::string& mainFile) {
    const std::string place = attribute(element, kPlaceAttribute);
    const size_t end = place.rfind(": ");
    return place.empty() ? MjcfPlace{mainFile, "line " + std::to_string(element.GetLineNum())}
                         : MjcfPlace{place.substr(0, end), place.substr(end + 2)};
}

MjcfClasses::MjcfClasses(const std::string& file, const tinyxml2::XMLElement& root)
    : file_(file)
    , main_(kMainClass) {
    for (auto* all = root.FirstChildElement("default"); all != nullptr;
         all = all->NextSiblingElement("default")) {
        read(*all, "", true);
    }
}

// Several <default> elements of the root, for example of included files, add to the main class.
void MjcfClasses::read(const tinyxml2::XMLElement& element, const std::string& above, bool main) {
    std::string name = attribute(element, "class");
    if (main) {
        main_ = classes_.empty() && !name.empty() ? name : main_;
        name = main_;
    } else if (name.empty()) {
        refuse(element, "without a class", "a class for each inner default");
    }
    Class& made = classes_[name];
    made.above = above;
    for (auto* child = element.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
        const std::string kind = child->Name();
        if (kind == "default") {
            read(*child, name, false);
        } else {
            made.elements[kind].push_back(child);
        }
    }
}

const char* MjcfClasses::find(const tinyxml2::XMLElement& element, const std::string& childClass,
                              const char* name) const {
    if (const char* const own = element.Attribute(name)) {
        return own;
    }
    std::string at = attribute(element, "class");
    at = !at.empty() ? at : !childClass.empty() ? childClass : main_;
    if (at != main_ && classes_.count(at) == 0) {
        refuse(element, "class '" + at + "'", "a class of <default>");
    }
    for (size_t depth = 0; !at.empty() && depth <= classes_.size(); ++depth) {
        const auto known = classes_.find(at);
        if (known == classes_.end()) {
            return nullptr;
        }
        const auto stated = known->second.elements.find(kindOf(element));
        if (stated != known->second.elements.end()) {
            for (auto last = stated->second.rbegin(); last != stated->second.rend(); ++last) {
                if (const char* const text = (*last)->Attribute(name)) {
                    return text;
                }
            }
        }
        at = known->second.above;
    }
    return nullptr;
}

std::vector<double> MjcfClasses::numbers(const tinyxml2::XMLElement& element, const std::string& childClass,
                                         const char* name, std::vector<double> absent, size_t least,
                                         size_t most) const {
    const char* const text = find(element, childClass, name);
    if (text == nullptr) {
        return absent;
    }
    std::vector<double> all;
    bool good = true;
    std::istringstream words(text);
    for (std::string word; good && words >> word;) {
        char* end = nullptr;
        all.push_back(std::strtod(word.c_str(), &end));
        good = *end == '\0' && std::isfinite(all.back()) && all.size() <= most;
    }
    if (!good || all.size() < least) {
        refuse(element, std::string(name) + "=\"" + std::string(text).substr(0, 60) + "\"",
               std::to_string(least) + (most > least ? ".." + std::to_string(most) : "") + " finite numbers");
    }
    return all;
}

void MjcfClasses::refuse(const tinyxml2::XMLElement& element, const std::string& value,
                         const std::string& allowed) const {
    const std::string name = attribute(element, "name");
    const MjcfPlace place = mjcfPlace(element, file_);
    throw BadInput(place.file,
                   place.line + ": <" + element.Name() + (name.empty() ? "" : " name=\"" + name + "\"") + ">",
                   value, allowed);
}

} // namespace fathom
