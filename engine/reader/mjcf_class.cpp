// SPDX-License-Identifier: Apache-2.0
#include "engine/reader/mjcf_class.h"

#include <cmath>
#include <cstdlib>
#include <optional>
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

// Nothing if there are more than `most`, or a word is no finite number.
std::optional<std::vector<double>> numbersIn(const char* text, size_t most) {
    std::vector<double> all;
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        char* end = nullptr;
        all.push_back(std::strtod(word.c_str(), &end));
        if (*end != '\0' || !std::isfinite(all.back()) || all.size() > most) {
            return std::nullopt;
        }
    }
    return all;
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
    const auto texts = statedBy(element, childClass, name);
    return texts.empty() ? nullptr : texts[0];
}

// All texts of an attribute, in the order of find().
std::vector<const char*> MjcfClasses::statedBy(const tinyxml2::XMLElement& element,
                                               const std::string& childClass, const char* name) const {
    std::vector<const char*> texts;
    const auto add = [&](const tinyxml2::XMLElement& from) {
        if (const char* const text = from.Attribute(name)) {
            texts.push_back(text);
        }
    };
    add(element);
    std::string at = attribute(element, "class");
    at = !at.empty() ? at : !childClass.empty() ? childClass : main_;
    if (at != main_ && classes_.count(at) == 0) {
        refuse(element, "class '" + at + "'", "a class of <default>");
    }
    for (size_t depth = 0; !at.empty() && depth <= classes_.size(); ++depth) {
        const auto known = classes_.find(at);
        if (known == classes_.end()) {
            break;
        }
        const auto stated = known->second.elements.find(kindOf(element));
        if (stated != known->second.elements.end()) {
            for (auto last = stated->second.rbegin(); last != stated->second.rend(); ++last) {
                add(**last);
            }
        }
        at = known->second.above;
    }
    return texts;
}

std::vector<double> MjcfClasses::numbers(const tinyxml2::XMLElement& element, const std::string& childClass,
                                         const char* name, std::vector<double> absent, size_t least,
                                         size_t most, bool fills) const {
    auto texts = statedBy(element, childClass, name);
    if (texts.empty()) {
        return absent;
    }
    texts.resize(fills ? texts.size() : 1);
    const char* fault = texts[0];
    std::vector<double> all;
    for (const char* const text : texts) {
        const auto own = numbersIn(text, most);
        if (!own) {
            fault = text;
            break;
        }
        for (size_t i = all.size(); i < own->size(); ++i) {
            all.push_back((*own)[i]);
        }
        if (all.size() >= least) {
            return all;
        }
    }
    refuse(element, std::string(name) + "=\"" + std::string(fault).substr(0, 60) + "\"",
           std::to_string(least) + (most > least ? ".." + std::to_string(most) : "") + " finite numbers");
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
