// SPDX-License-Identifier: Apache-2.0
// A value of a JSON file with its dotted path; every access is checked.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fathom {

// Throws BadInput naming file, dotted path, value and what is allowed. Views into a document that must
// outlive it.
class JsonField {
public:
    JsonField(const nlohmann::json& value, std::string file, std::string path)
        : value_(&value)
        , file_(std::move(file))
        , path_(std::move(path)) {}

    std::optional<JsonField> find(std::string_view key) const; // throws when this is not an object
    JsonField at(std::string_view key) const;                  // throws when the key is missing

    // This value as the given type; throws otherwise.
    double finite() const;
    double positive(const std::string& hint = "") const; // hint: behind what is allowed
    uint32_t integer(uint32_t lo, uint32_t hi) const;    // lo..hi, both allowed
    bool boolean() const;
    std::string text() const;
    std::vector<std::string> keys() const; // of an object; else none
    bool isText() const { return value_->is_string(); }
    bool isNumber() const { return value_->is_number(); }
    bool isNumbers() const; // a list of nothing else
    bool isTrue() const { return value_->is_boolean() && value_->get<bool>(); }
    bool isEmpty() const { return value_->empty(); } // null, or a list or an object without values
    bool is(double number) const;                    // within a millionth
    // Null, true or false, 0, a list or an object of nothing else, or text that begins with no number.
    bool isNothing() const;
    std::vector<double> numbers() const;         // list of finite numbers, any length
    std::vector<double> numbers(size_t n) const; // of exactly n

    // Shows this value in 80 characters at most, and of lists and objects nothing below the first level.
    [[noreturn]] void refuse(const std::string& allowed) const;
    const std::string& path() const { return path_; }

private:
    const nlohmann::json* value_;
    std::string file_;
    std::string path_; // empty for the whole document
};

// Throws BadInput that names the file when it cannot be read, is not JSON, or gives a key twice.
nlohmann::json parseJsonFile(const std::filesystem::path& file);

} // namespace fathom
