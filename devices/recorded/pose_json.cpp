// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/pose_json.h"

#include "devices/recorded/name_words.h"
#include "devices/recorded/pose_text.h"
#include "devices/recorded/text_file.h"
#include "engine/types/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace fathom {

namespace {

std::string joinedWords(const std::string& key) {
    std::string plain;
    std::ranges::for_each(nameWords(key), [&](const std::string& word) { plain += word; });
    return plain;
}

// Of one camera pose: Nerfstudio (transform_matrix), SDFStudio (camtoworld), 3D Scanner App
// (cameraPoseARFrame).
bool isPoseKey(const std::string& plain) {
    constexpr std::array<std::string_view, 5> kKeys{"transformmatrix", "camtoworld", "cam2world",
                                                    "cameratoworld", "c2w"};
    return std::ranges::find(kKeys, plain) != kKeys.end() || plain.starts_with("camerapose");
}

bool isQuaternionKey(const std::string& plain) {
    constexpr std::array<std::string_view, 4> kKeys{"rotation", "orientation", "quaternion", "qvec"};
    return std::ranges::find(kKeys, plain) != kKeys.end();
}

// Receives the events of nlohmann's parser; false ends it.
class PoseSearch final : public nlohmann::json_sax<nlohmann::json> {
public:
    explicit PoseSearch(size_t fewest)
        : fewest_(fewest) {}
    bool found() const { return found_; }

    bool null() override { return true; }
    bool boolean(bool) override { return true; }
    bool number_integer(number_integer_t value) override { return add(static_cast<double>(value)); }
    bool number_unsigned(number_unsigned_t value) override { return add(static_cast<double>(value)); }
    bool number_float(number_float_t value, const string_t&) override { return add(value); }
    bool string(string_t&) override { return true; }
    bool binary(binary_t&) override { return true; }
    bool key(string_t& key) override {
        key_ = joinedWords(key);
        ofOther_ = nameOtherThing(nameWords(key));
        listsPoses_ = starts_.size() == 1 ? key == "poses" : listsPoses_;
        found_ = found_ || isPoseKey(key_);
        std::erase_if(key_, [](char c) { return c >= '0' && c <= '9'; }); // numbers of frames
        return !found_;
    }
    bool start_object(size_t) override { return open(); }
    bool end_object() override {
        numbers_.resize(starts_.back());
        return close();
    }
    bool start_array(size_t) override {
        found_ = found_ || (listsPoses_ && starts_.size() == 2);
        return open() && !found_;
    }
    bool end_array() override {
        judge();
        return close() && !found_;
    }
    bool parse_error(size_t, const std::string&, const nlohmann::json::exception&) override { return false; }

private:
    static constexpr size_t kRows = 12, kMatrix = 16; // numbers

    bool add(double value) {
        if (starts_.empty() || numbers_.size() <= starts_.back() + kMatrix) { // more are no matrix
            numbers_.push_back(value);
        }
        return true;
    }
    bool open() {
        starts_.push_back(numbers_.size());
        otherThing_ = ofOther_ && otherThing_ == 0 ? starts_.size() : otherThing_;
        ofOther_ = false;
        return true;
    }
    // Numbers of up to a matrix are left to the list around, which may have one row in each list.
    bool close() {
        const size_t count = numbers_.size() - starts_.back();
        if (count >= kRows || starts_.size() == 1) {
            numbers_.resize(starts_.back());
        }
        otherThing_ = otherThing_ == starts_.size() ? 0 : otherThing_;
        starts_.pop_back();
        if (!starts_.empty()) {
            numbers_.resize(std::min(numbers_.size(), starts_.back() + kMatrix + 1));
        }
        return true;
    }
    // Of the list that ends.
    void judge() {
        constexpr double kMaxOff = 1e-3;
        const std::vector<double> list(numbers_.begin() + static_cast<long>(starts_.back()), numbers_.end());
        double square = 0.0;
        std::ranges::for_each(list, [&](double value) { square += value * value; });
        const bool quaternion =
            list.size() == 4 && isQuaternionKey(key_) && std::abs(std::sqrt(square) - 1.0) < kMaxOff;
        const bool motion = (list.size() == kRows || list.size() == kMatrix) && isMotion(list);
        if (otherThing_ > 0 || !(quaternion || motion)) {
            return;
        }
        Motions& motions = motions_[key_];
        motions.first = motions.count == 0 ? list : motions.first;
        motions.differ = motions.differ || list != motions.first;
        found_ = found_ || (++motions.count >= fewest_ && motions.differ);
    }

    size_t fewest_; // motions
    // Under one key.
    struct Motions {
        std::vector<double> first;
        size_t count = 0;
        bool differ = false;
    };
    std::map<std::string, Motions> motions_;
    std::vector<double> numbers_; // of the open lists
    std::vector<size_t> starts_;  // of each open list or object in numbers_
    std::string key_;
    size_t otherThing_ = 0; // depth of the open field that another thing owns; 0 = none
    bool ofOther_ = false, listsPoses_ = false, found_ = false;
};

} // namespace

bool holdsJsonPoses(const std::filesystem::path& file, size_t fewest) {
    PoseSearch search(fewest);
    try {
        const std::string text = readTextFile(file);
        nlohmann::json::sax_parse(text, &search);
    } catch (const Error&) { // of no interest to the recording that is read
    }
    return search.found();
}

} // namespace fathom
