// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/numbered_images.h"

#include "devices/images/depth_image.h"
#include "devices/recorded/image_views.h"
#include "devices/recorded/name_number.h"
#include "engine/types/error.h"
#include "engine/types/log.h"
#include "engine/types/read_file.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <vector>

namespace fathom {

namespace {

constexpr double kPeriod = 1.0 / 30.0; // [s] of layouts without stamps
using ImageKey = std::vector<NameNumber>;

std::string keyText(const ImageKey& key) {
    std::string text;
    for (const NameNumber& number : key) {
        text += text.empty() ? "" : "-";
        text += number.text();
    }
    return text;
}

struct NamedImage {
    std::filesystem::path file;
    ImageKey first, last, all; // numbers of the name
};

// A file, and the part of its name that tells its number.
struct NamedFile {
    std::filesystem::path file;
    std::string stem;

    bool endsInNumber() const { return kDigits.find(stem.back()) != std::string::npos; }
};

std::vector<NamedFile> filesIn(const NumberedImages& images) {
    std::vector<NamedFile> found;
    std::error_code failed;
    for (const auto& entry : std::filesystem::directory_iterator(images.folder, failed)) {
        std::string stem = entry.path().stem().string();
        if (endsAs(entry.path(), images.endings) && stem.ends_with(images.before) && stem != images.before) {
            stem.resize(stem.size() - images.before.size());
            found.push_back({entry.path(), std::move(stem)});
        }
    }
    std::ranges::sort(found, {}, &NamedFile::file); // one result whatever the order of the folder
    return found;
}

// Those whose names end in a number; if there are none, those with a number anywhere (0000_depth.png). The
// others are images of another kind, or have hexadecimal numbers.
std::vector<NamedFile> numberedFiles(const NumberedImages& images) {
    std::vector<NamedFile> files = filesIn(images), others;
    const bool atEnd = std::ranges::any_of(files, &NamedFile::endsInNumber);
    std::erase_if(files, [&](const NamedFile& file) {
        const bool other =
            atEnd ? !file.endsInNumber() : file.stem.find_first_of(kDigits) == std::string::npos;
        if (other) {
            others.push_back(file);
        }
        return other;
    });
    if (!others.empty() && !files.empty()) {
        log::warn("{}: {} of {} images are not played, because their names do not {} a decimal number; "
                  "first: {}",
                  images.folder.string(), others.size(), others.size() + files.size(),
                  atEnd ? "end in" : "have", others.front().file.filename().string());
    }
    return files;
}

std::vector<std::string> stemsOf(const std::vector<NamedFile>& files) {
    std::vector<std::string> stems;
    std::ranges::transform(files, std::back_inserter(stems), &NamedFile::stem);
    return stems;
}

// others: the files of the other kind; points in both kinds of names mean the same.
std::vector<NamedImage> imagesOf(const std::vector<NamedFile>& files, const std::vector<NamedFile>& others) {
    std::vector<ImageKey> numbers = numbersInNames(stemsOf(files), stemsOf(others));
    std::vector<NamedImage> found;
    for (size_t i = 0; i < files.size(); ++i) {
        ImageKey& all = numbers[i];
        found.push_back({files[i].file, {all.front()}, {all.back()}, std::move(all)});
    }
    return found;
}

bool haveTimeNames(const std::vector<NamedImage>& images) {
    return std::ranges::all_of(images, [](const NamedImage& image) { return isDateOrTime(image.all); });
}

void refuseViews(const std::filesystem::path& folder, const std::vector<NamedImage>& images) {
    std::vector<ImageKey> names;
    std::ranges::transform(images, std::back_inserter(names), &NamedImage::all);
    if (const auto views = severalViews(names)) {
        throw BadInput(folder.string(), "names of images",
                       images[views->first].file.filename().string() + " and " +
                           images[views->second].file.filename().string() +
                           ", as of several cameras: the same " + std::to_string(views->last) +
                           " last numbers behind " + std::to_string(views->fronts) + " others",
                       "the images of one camera");
    }
}

using ByNumber = std::map<ImageKey, std::filesystem::path>;

// Both folders by the first or the last number of their names.
struct Match {
    ByNumber depth, colour;
    std::string twice; // two images of one number; empty = none
    size_t pairs = 0;
};

void sortImages(const std::vector<NamedImage>& images, ImageKey NamedImage::*number, ByNumber& sorted,
                std::string& twice) {
    for (const NamedImage& image : images) {
        const auto [at, added] = sorted.emplace(image.*number, image.file);
        if (!added && twice.empty()) {
            twice = at->second.filename().string() + " and " + image.file.filename().string() + " with " +
                    keyText(at->first);
        }
    }
}

Match matchBy(const std::vector<NamedImage>& depth, const std::vector<NamedImage>& colour,
              ImageKey NamedImage::*number) {
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

// A file with a number in its name, the first one by name; empty = none.
std::string numberedFileIn(const std::filesystem::path& folder) {
    std::string first;
    std::error_code failed;
    for (const auto& entry : std::filesystem::directory_iterator(folder, failed)) {
        const std::string name = entry.path().filename().string();
        const bool numbered = entry.path().stem().string().find_first_of(kDigits) != std::string::npos;
        if (numbered && isRegularFile(entry.path()) && (first.empty() || name < first)) {
            first = name;
        }
    }
    return first;
}

// kind: "depth images".
[[noreturn]] void refuseNone(const NumberedImages& images, const std::string& kind, const std::string& hint) {
    const std::string other = images.before.empty() ? numberedFileIn(images.folder) : "";
    std::string endings;
    for (const std::string_view ending : images.endings) {
        endings += (endings.empty() ? "" : ", ") + std::string(ending);
    }
    throw BadInput(images.folder.string(), kind,
                   other.empty() ? "none" : "none that is read; there is " + other,
                   (other.empty() ? "at least one, with" : endings + " with") +
                       std::string(" a number in its name") + hint);
}

// '%d.%d' of seconds and parts of them loses the zeros in front of these, and with them the order. True names
// of so many digits hardly ever have none that begins with 0. No decimals of different lengths end in 0.
void warnIfUnpadded(const std::filesystem::path& folder, const std::vector<NamedImage>& images) {
    constexpr size_t kMicroseconds = 6; // digits
    std::vector<ImageKey> numbers;
    std::ranges::transform(images, std::back_inserter(numbers), &NamedImage::last);
    const PointDigits digits = pointDigits(numbers);
    const bool stamps = digits.front >= kStampDigits && digits.longest >= kMicroseconds;
    if (digits.unpadded && (stamps || digits.endInZero)) {
        log::warn("{}: seconds in the names have {} to {} digits after the point, none beginning with 0 "
                  "(first: {}): if they are parts of a second without leading zeros, the order is wrong",
                  folder.string(), digits.shortest, digits.longest,
                  images[digits.example].file.filename().string());
    }
}

std::vector<NamedFile> depthFilesIn(const NumberedImages& depth) {
    std::vector<NamedFile> files = numberedFiles(depth);
    if (files.empty()) {
        refuseNone(depth, "depth images", "");
    }
    return files;
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
            line.fault = "no colour image with the number " + keyText(number);
        } else {
            line.colour = pair->second;
        }
        index.push_back(std::move(line));
    }
    return index;
}

std::vector<IndexLine> depthByNumber(const NumberedImages& depth) {
    const std::vector<NamedImage> found = imagesOf(depthFilesIn(depth), {});
    warnIfUnpadded(depth.folder, found);
    const bool times = haveTimeNames(found);
    if (times) {
        refuseViews(depth.folder, found);
    }
    Match images = matchBy(found, {}, times ? &NamedImage::all : &NamedImage::last);
    if (Match first = matchBy(found, {}, &NamedImage::first); !images.twice.empty() && first.twice.empty()) {
        images = std::move(first); // 0000_depth16
    }
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
    const std::vector<NamedFile> depthFiles = depthFilesIn(depth), colourFiles = numberedFiles(colour);
    if (colourFiles.empty()) {
        refuseNone(colour, "colour images", ", or colour=none after the folder name");
    }
    const std::vector<NamedImage> depthImages = imagesOf(depthFiles, colourFiles),
                                  colourImages = imagesOf(colourFiles, depthFiles);
    warnIfUnpadded(depth.folder, depthImages);
    const Match last = matchBy(depthImages, colourImages, &NamedImage::last);
    const Match first = matchBy(depthImages, colourImages, &NamedImage::first);
    if (haveTimeNames(depthImages) && haveTimeNames(colourImages)) {
        refuseViews(depth.folder, depthImages);
        const Match all = matchBy(depthImages, colourImages, &NamedImage::all);
        const auto isBetter = [](const Match& other, const Match& than) {
            return other.twice.empty() && other.pairs > than.pairs;
        };
        if (all.twice.empty() && !isBetter(last, all) && !isBetter(first, all)) {
            return pairsOf(all, depth.folder);
        }
    }
    const bool byFirst = first.twice.empty() && (!last.twice.empty() || first.pairs > last.pairs);
    refuseTwice(depth, byFirst ? "" : last.twice);
    return pairsOf(byFirst ? first : last, depth.folder);
}

std::string imageNumber(const std::filesystem::path& file) {
    const std::vector<NameNumber> numbers = numbersIn(file.stem().string());
    return numbers.empty() ? "" : numbers.back().text();
}

} // namespace fathom
