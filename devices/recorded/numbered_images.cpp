// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/numbered_images.h"

#include "devices/images/depth_image.h"
#include "engine/types/error.h"
#include "engine/types/log.h"

#include <algorithm>
#include <map>
#include <tuple>

namespace fathom {

namespace {

constexpr double kPeriod = 1.0 / 30.0; // [s] of layouts without stamps
constexpr std::string_view kDigits = "0123456789";

// Of any length, which no integer type holds: stamps in nanoseconds have 19 digits.
struct NameNumber {
    std::string whole, fraction; // without leading and trailing zeros

    bool operator<(const NameNumber& other) const {
        const size_t length = whole.size(), otherLength = other.whole.size();
        return std::tie(length, whole, fraction) < std::tie(otherLength, other.whole, other.fraction);
    }
    std::string text() const {
        return (whole.empty() ? "0" : whole) + (fraction.empty() ? "" : "." + fraction);
    }
};

// In the order of the name.
std::vector<NameNumber> numbersIn(const std::string& name) {
    std::vector<NameNumber> numbers;
    for (size_t begin = name.find_first_of(kDigits); begin != std::string::npos;
         begin = name.find_first_of(kDigits, begin)) {
        size_t end = std::min(name.find_first_not_of(kDigits, begin), name.size());
        NameNumber number;
        number.whole = name.substr(begin, end - begin);
        number.whole.erase(0, number.whole.find_first_not_of('0'));
        if (end + 1 < name.size() && name[end] == '.' && kDigits.find(name[end + 1]) != std::string::npos) {
            begin = end + 1;
            end = std::min(name.find_first_not_of(kDigits, begin), name.size());
            number.fraction = name.substr(begin, end - begin);
            number.fraction.erase(number.fraction.find_last_not_of('0') + 1);
        }
        numbers.push_back(std::move(number));
        begin = end;
    }
    return numbers;
}

struct NamedImage {
    std::filesystem::path file;
    NameNumber first, last;
};

std::vector<NamedImage> imagesIn(const NumberedImages& images) {
    std::vector<NamedImage> found;
    std::error_code failed;
    for (const auto& entry : std::filesystem::directory_iterator(images.folder, failed)) {
        std::string stem = entry.path().stem().string();
        if (!endsAs(entry.path(), images.endings) || !stem.ends_with(images.before)) {
            continue;
        }
        stem.resize(stem.size() - images.before.size());
        if (!stem.empty() && kDigits.find(stem.back()) != std::string::npos) {
            const std::vector<NameNumber> numbers = numbersIn(stem);
            found.push_back({entry.path(), numbers.front(), numbers.back()});
        }
    }
    std::ranges::sort(found, {}, &NamedImage::file); // one result whatever the order of the folder
    return found;
}

using ByNumber = std::map<NameNumber, std::filesystem::path>;

// Both folders by the first or the last number of their names.
struct Match {
    ByNumber depth, colour;
    std::string twice; // two images of one number; empty = none
    size_t pairs = 0;
};

void sortImages(const std::vector<NamedImage>& images, NameNumber NamedImage::*number, ByNumber& sorted,
                std::string& twice) {
    for (const NamedImage& image : images) {
        const auto [at, added] = sorted.emplace(image.*number, image.file);
        if (!added && twice.empty()) {
            twice = at->second.filename().string() + " and " + image.file.filename().string() + " with " +
                    at->first.text();
        }
    }
}

Match matchBy(const std::vector<NamedImage>& depth, const std::vector<NamedImage>& colour,
              NameNumber NamedImage::*number) {
    Match match;
    sortImages(depth, number, match.depth, match.twice);
    sortImages(colour, number, match.colour, match.twice);
    for (const auto& [key, unused] : match.depth) {
        match.pairs += match.colour.count(key);
    }
    return match;
}

IndexLine lineOf(size_t index, const std::filesystem::path& depth) {
    const double stamp = kPeriod * static_cast<double>(index);
    return {stamp, stamp, depth, {}, "", std::nullopt};
}

std::vector<NamedImage> depthImagesIn(const NumberedImages& depth) {
    std::vector<NamedImage> images = imagesIn(depth);
    if (images.empty()) {
        throw BadInput(depth.folder.string(), "depth images", "none",
                       "at least one, with a number in its name");
    }
    return images;
}

void refuseTwice(const NumberedImages& images, const std::string& twice) {
    if (!twice.empty()) {
        throw BadInput(images.folder.string(), "names of images", twice, "one image of each number");
    }
}

std::vector<IndexLine> pairsOf(const Match& match, const std::filesystem::path& folder) {
    std::vector<IndexLine> index;
    const bool inOrder = 2 * match.pairs < match.depth.size() && match.depth.size() == match.colour.size();
    if (inOrder) {
        log::warn("{}: depth and colour images have different numbers: they are paired in order",
                  folder.string());
    }
    auto next = match.colour.begin();
    for (const auto& [number, file] : match.depth) {
        IndexLine line = lineOf(index.size(), file);
        const auto pair = inOrder ? next++ : match.colour.find(number);
        if (pair == match.colour.end()) {
            line.fault = "no colour image with the number " + number.text();
        } else {
            line.colour = pair->second;
        }
        index.push_back(std::move(line));
    }
    return index;
}

std::vector<IndexLine> depthByNumber(const NumberedImages& depth) {
    const Match images = matchBy(depthImagesIn(depth), {}, &NamedImage::last);
    refuseTwice(depth, images.twice);
    std::vector<IndexLine> index;
    for (const auto& [number, file] : images.depth) {
        index.push_back(lineOf(index.size(), file));
    }
    return index;
}

} // namespace

std::vector<IndexLine> pairByNumber(const NumberedImages& depth, const NumberedImages& colour,
                                    bool depthOnly) {
    if (depthOnly) {
        return depthByNumber(depth);
    }
    const std::vector<NamedImage> depthImages = depthImagesIn(depth), colourImages = imagesIn(colour);
    if (colourImages.empty()) {
        throw BadInput(colour.folder.string(), "colour images", "none",
                       "at least one, with a number in its name, or colour=none behind the folder's name");
    }
    const Match last = matchBy(depthImages, colourImages, &NamedImage::last);
    const Match first = matchBy(depthImages, colourImages, &NamedImage::first);
    const bool byFirst = first.twice.empty() && (!last.twice.empty() || first.pairs > last.pairs);
    refuseTwice(depth, byFirst ? "" : last.twice);
    return pairsOf(byFirst ? first : last, depth.folder);
}

std::string imageNumber(const std::filesystem::path& file) {
    const std::vector<NameNumber> numbers = numbersIn(file.stem().string());
    return numbers.empty() ? "" : numbers.back().text();
}

} // namespace fathom
