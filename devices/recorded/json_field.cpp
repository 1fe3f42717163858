// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/json_field.h"

#include "devices/recorded/text_file.h"
#include "engine/types/error.h"
#include "engine/types/stand_in.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

namespace fathom {

namespace {

constexpr size_t kShownCharacters = 80, kReasonCharacters = 240;

std::string scalar(const nlohmann::json& value) {
    return value.is_structured() ? "..."
                                 : value.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

// Prints only the top level of a list: the library's writer is recursive, and deeply nested files could
// overflow the stack.
std::string shown(const nlohmann::json& value) {
    if (value.is_object()) {
        return "an object";
    }
    if (!value.is_array()) {
        return excerpt(scalar(value), kShownCharacters);
    }
    std::string all = "[";
    for (size_t i = 0; i < value.size() && all.size() <= kShownCharacters; ++i) {
        all += (i == 0 ? "" : ",") + scalar(value[i]);
    }
    return excerpt(all + "]", kShownCharacters);
}

// The library's message quotes the last token in full, whatever its length.
std::string reasonOf(const nlohmann::json::exception& e) {
    std::string reason = e.what();
    std::replace_if(
        reason.begin(), reason.end(), [](unsigned char c) { return c >= 0x80; }, '?');
    return excerpt(std::move(reason), kReasonCharacters);
}

// Refuses an object with two values of one key: the library would keep the last one. Discards all values.
void refuseKeysTwice(const std::filesystem::path& file, const std::string& text) {
    struct Level {
        std::set<std::string> keys;
        std::string last;
    };
    std::vector<Level> open; // objects and lists around the value that is read
    using Event = nlohmann::json::parse_event_t;
    const auto watch = [&](int depth, Event event, const nlohmann::json& parsed) {
        open.resize(static_cast<size_t>(depth));
        if (event == Event::object_start || event == Event::array_start) {
            open.emplace_back();
        } else if (event == Event::key) {
            open.back().last = parsed.get<std::string>();
            if (!open.back().keys.insert(open.back().last).second) {
                std::string path;
                for (const Level& level : open) {
                    path += (path.empty() || level.last.empty() ? "" : ".") + level.last;
                }
                throw BadInput(file.string(), excerpt(path, kShownCharacters), "given twice",
                               "each key once in an object");
            }
        }
        return false;
    };
    std::ignore = nlohmann::json::parse(text, watch);
}

// To a few levels: deeply nested files could overflow the stack.
bool isEmptyValue(const nlohmann::json& value, int level) {
    constexpr int kDeepest = 4;
    if (value.is_structured()) {
        return std::all_of(value.begin(), value.end(), [level](const nlohmann::json& one) {
            return level < kDeepest && isEmptyValue(one, level + 1);
        });
    }
    if (value.is_string()) {
        const auto text = value.get<std::string>();
        const size_t first = text.find_first_not_of(" [(");
        return first == std::string::npos ||
               std::string_view("+-.0123456789").find(text[first]) == std::string_view::npos;
    }
    return !value.is_number() || value.get<double>() == 0.0;
}

} // namespace

std::optional<JsonField> JsonField::find(std::string_view key) const {
    if (!value_->is_object()) {
        refuse("an object");
    }
    const auto found = value_->find(std::string(key));
    if (found == value_->end()) {
        return std::nullopt;
    }
    return JsonField(*found, file_, path_.empty() ? std::string(key) : path_ + "." + std::string(key));
}

JsonField JsonField::at(std::string_view key) const {
    const std::optional<JsonField> field = find(key);
    if (!field) {
        throw BadInput(file_, path_.empty() ? std::string(key) : path_ + "." + std::string(key), "missing",
                       "this field must be given");
    }
    return *field;
}

double JsonField::finite() const {
    const double x = value_->is_number() ? value_->get<double>() : std::nan("");
    if (!std::isfinite(x)) {
        refuse("a finite number");
    }
    return x;
}

double JsonField::positive(const std::string& hint) const {
    const double x = value_->is_number() ? value_->get<double>() : std::nan("");
    if (!std::isfinite(x) || !(x > 0.0)) {
        refuse("a number above 0" + hint);
    }
    return x;
}

uint32_t JsonField::integer(uint32_t lo, uint32_t hi) const {
    const double x = value_->is_number() ? value_->get<double>() : std::nan("");
    if (!(x >= lo && x <= hi) || x != std::floor(x)) { // 80.0 is whole: some writers know only doubles
        refuse("a whole number from " + std::to_string(lo) + " to " + std::to_string(hi));
    }
    return static_cast<uint32_t>(x);
}

bool JsonField::boolean() const {
    if (!value_->is_boolean()) {
        refuse("true or false");
    }
    return value_->get<bool>();
}

std::vector<std::string> JsonField::keys() const {
    std::vector<std::string> all;
    if (value_->is_object()) {
        for (const auto& [key, unused] : value_->items()) {
            all.push_back(key);
        }
    }
    return all;
}

bool JsonField::is(double number) const {
    return value_->is_number() && std::abs(value_->get<double>() - number) <= 1e-6 * std::abs(number);
}

bool JsonField::isNumbers() const {
    return value_->is_array() &&
           std::ranges::all_of(*value_, [](const auto& one) { return one.is_number(); });
}

bool JsonField::isNothing() const {
    return isEmptyValue(*value_, 0);
}

std::string JsonField::text() const {
    if (!value_->is_string()) {
        refuse("text");
    }
    return value_->get<std::string>();
}

std::vector<double> JsonField::numbers() const {
    if (!value_->is_array()) {
        refuse("a list of numbers");
    }
    std::vector<double> all;
    for (const nlohmann::json& item : *value_) {
        all.push_back(JsonField(item, file_, path_ + "[" + std::to_string(all.size()) + "]").finite());
    }
    return all;
}

std::vector<double> JsonField::numbers(size_t n) const {
    std::vector<double> all = numbers();
    if (all.size() != n) {
        refuse("a list of " + std::to_string(n) + " numbers");
    }
    return all;
}

void JsonField::refuse(const std::string& allowed) const {
    throw BadInput(file_, path_.empty() ? "file" : path_, shown(*value_), allowed);
}

nlohmann::json parseJsonFile(const std::filesystem::path& file) {
    const std::string text = readTextFile(file);
    refuseUtf16(file, text, "a readable text file");
    try {
        refuseKeysTwice(file, text);
        return nlohmann::json::parse(text);
    } catch (const nlohmann::json::exception& e) { // its message has line, column and the last token
        const size_t first = std::min(text.find_first_not_of(" \t\r\n"), text.size());
        if (first < text.size() && std::string_view("{[\xef").find(text[first]) == std::string_view::npos) {
            throw BadInput(
                file.string(), "syntax",
                "not JSON, begins with " +
                    excerpt(text.substr(first, text.find('\n', first) - first), kShownCharacters),
                "JSON with the fields of docs/guide/recordings.md; YAML calibrations are not read");
        }
        throw BadInput(file.string(), "syntax", reasonOf(e), "JSON (which has no NaN or infinity)");
    }
}

} // namespace fathom
