// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/recording_index.h"

#include "devices/images/depth_image.h"
#include "devices/recorded/name_number.h"
#include "devices/recorded/small_units.h"
#include "devices/recorded/stamped_files.h"
#include "devices/recorded/text_file.h"
#include "engine/types/error.h"
#include "engine/types/inside.h"
#include "engine/types/log.h"
#include "engine/types/number_text.h"
#include "engine/types/read_file.h"
#include "engine/types/split_words.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace fathom {

namespace {

namespace fs = std::filesystem;

constexpr double kTumTolerance = 0.02; // [s] the default of associate.py
constexpr size_t kCandidates = 4;      // colour stamps tried on either side of a depth stamp

// Whether a path has the word depth after the folders that it shares with the other one.
bool namesDepth(std::string_view path, std::string_view other) {
    const auto differ = std::ranges::mismatch(path, other).in1;
    const std::string_view common(path.begin(), differ);
    return path.find("depth", common.rfind('/') + 1) != std::string_view::npos; // npos + 1 = 0: no folder
}

// Faulty lines get the stamp of a neighbour, so that no time is measured from zero.
void stampFaulty(std::vector<IndexLine>& index) {
    const auto first = std::ranges::find_if(index, [](const IndexLine& line) { return line.fault.empty(); });
    double stamp = first == index.end() ? 0.0 : first->depthStamp;
    for (IndexLine& line : index) {
        if (line.fault.empty()) {
            stamp = line.depthStamp;
        } else {
            line.depthStamp = line.colourStamp = stamp;
        }
    }
}

std::vector<IndexLine> readAssociations(const fs::path& folder) {
    const fs::path file = folder / "associations.txt";
    std::vector<IndexLine> index;
    for (const TextLine& line : readDataLines(file)) {
        std::vector<std::string_view> words = splitWords(line.text);
        IndexLine entry;
        if (words.size() == 4) { // some tools write depth first: 't_depth depth/x.png t_rgb rgb/x.png'
            const bool first = namesDepth(words[1], words[3]), second = namesDepth(words[3], words[1]);
            entry.orderGuessed = first == second;
            std::rotate(words.begin(), words.begin() + (first && !second ? 2 : 0), words.end());
        }
        if (words.size() != 4) {
            const std::string columns = columnFault(line.text);
            entry.fault = "line " + std::to_string(line.number) + " " +
                          (columns.empty() ? "is not 't_rgb rgb/x.png t_depth depth/x.png'" : columns);
        } else if (!parseStamp(words[0], entry.colourStamp) || !parseStamp(words[2], entry.depthStamp)) {
            const bool colour = parseStamp(words[0], entry.colourStamp);
            entry.fault =
                "line " + std::to_string(line.number) + " " + stampFault(line.text, words[colour ? 2 : 0]);
        } else if (!staysInside(pathOf(folder, words[1])) || !staysInside(pathOf(folder, words[3]))) {
            entry.fault = "line " + std::to_string(line.number) + " points outside the recording's folder";
        } else {
            entry.colour = folder / pathOf(folder, words[1]);
            entry.depth = folder / pathOf(folder, words[3]);
        }
        index.push_back(std::move(entry));
    }
    stampFaulty(index);
    return index;
}

std::vector<StampedFile> stampFilesOf(const fs::path& folder, const std::vector<double>& stamps,
                                      const char* field, std::span<const std::string_view> endings) {
    std::vector<fs::path> names;
    std::error_code failed;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, failed)) {
        if (endsAs(entry.path(), endings)) {
            names.push_back(entry.path());
        }
    }
    sortByName(names);
    if (names.size() != stamps.size()) {
        throw BadInput((folder.parent_path() / "intrinsics.json").string(), field,
                       std::to_string(stamps.size()) + " stamps",
                       std::to_string(names.size()) + ", as many as there are images in " + folder.string());
    }
    std::vector<StampedFile> files;
    for (size_t i = 0; i < names.size(); ++i) {
        files.push_back({stamps[i], names[i]});
    }
    return files;
}

struct Candidate {
    double distance; // [s]
    size_t depth, colour;
};

// All close pairs, closest first; a bounded number per depth image, so that equal stamps do not cause
// quadratic cost. The candidates of the nth of several depth images in a row with one stamp begin at the nth
// colour.
std::vector<Candidate> closePairs(const std::vector<StampedFile>& depth,
                                  const std::vector<StampedFile>& colour, double within) {
    std::vector<Candidate> pairs;
    size_t alike = 0; // depth images before this one with its stamp
    for (size_t d = 0; d < depth.size(); ++d) {
        alike = d > 0 && depth[d].stamp == depth[d - 1].stamp ? alike + 1 : 0;
        const auto at = std::ranges::lower_bound(colour, depth[d].stamp, {}, &StampedFile::stamp);
        const size_t middle = std::min(static_cast<size_t>(at - colour.begin()) + alike, colour.size());
        const size_t last = std::min(middle + kCandidates, colour.size());
        for (size_t c = middle - std::min(middle, kCandidates); c < last; ++c) {
            const double distance = std::abs(colour[c].stamp - depth[d].stamp);
            if (distance <= within) {
                pairs.push_back({distance, d, c});
            }
        }
    }
    std::ranges::stable_sort(pairs, {}, &Candidate::distance);
    return pairs;
}

// Whether there was colour at this time: one stream may begin or end before the other.
bool spans(const std::vector<StampedFile>& colour, double stamp, double within) {
    return !colour.empty() && stamp >= colour.front().stamp - within && stamp <= colour.back().stamp + within;
}

// Stamps in another unit than seconds pair by chance, or not at all; empty = they look like seconds.
std::string unitHint(const std::vector<StampedFile>& depth) {
    const double whole = depth.empty() ? 0.0 : depth.back().stamp - depth.front().stamp;
    const SmallUnit* unit =
        depth.size() > 1 ? smallUnitOf(whole / static_cast<double>(depth.size() - 1)) : nullptr;
    return unit == nullptr ? "" : std::string("; stamps are read as seconds, but look like ") + unit->name;
}

// In the order of `depth`; colour in order of its stamps.
std::vector<IndexLine> associate(const std::vector<StampedFile>& depth,
                                 const std::vector<StampedFile>& colour, double within) {
    const size_t none = colour.size();
    std::vector<size_t> colourOf(depth.size(), none);
    std::vector<bool> taken(colour.size(), false);
    for (const Candidate& pair : closePairs(depth, colour, within)) {
        if (colourOf[pair.depth] == none && !taken[pair.colour]) {
            colourOf[pair.depth] = pair.colour;
            taken[pair.colour] = true;
        }
    }
    std::vector<IndexLine> index;
    size_t lost = 0;
    for (size_t d = 0; d < depth.size(); ++d) {
        if (colourOf[d] == none) {
            lost += spans(colour, depth[d].stamp, within) ? 1 : 0;
            continue;
        }
        const StampedFile& c = colour[colourOf[d]];
        index.push_back({depth[d].stamp, c.stamp, depth[d].file, c.file, "", std::nullopt});
    }
    if (lost > 0) {
        log::warn("{} of {} depth images have no colour image within {} s: they are not played{}", lost,
                  depth.size(), significant(within, 4), unitHint(depth));
    }
    return index;
}

std::vector<IndexLine> withoutColour(std::vector<StampedFile> depth) {
    std::vector<IndexLine> index;
    for (StampedFile& image : depth) {
        index.push_back({image.stamp, image.stamp, std::move(image.file), {}, "", std::nullopt});
    }
    return index;
}

std::vector<StampedFile> stampedDepth(const fs::path& folder, const RecordingIntrinsics& intrinsics) {
    return stampFilesOf(folder / "depth", intrinsics.depthStamps, "depth_stamps_s", kDepthEndings);
}

// An index, and the files that it comes from.
struct FoundIndex {
    std::vector<IndexLine> lines;
    std::string source;
    std::string whyNone = {}; // there are no lines
};

// The smallest distance of a depth stamp from a colour stamp; colour in order of its stamps, not empty.
double nearestApart(const std::vector<StampedFile>& depth, const std::vector<StampedFile>& colour) {
    double nearest = HUGE_VAL;
    for (const StampedFile& image : depth) {
        const auto after = std::ranges::lower_bound(colour, image.stamp, {}, &StampedFile::stamp);
        nearest = after == colour.end() ? nearest : std::min(nearest, after->stamp - image.stamp);
        nearest = after == colour.begin() ? nearest : std::min(nearest, image.stamp - (after - 1)->stamp);
    }
    return nearest;
}

FoundIndex pairedByStamp(const std::vector<StampedFile>& depth, std::vector<StampedFile> colour,
                         double within, const std::string& source) {
    std::ranges::stable_sort(colour, {}, &StampedFile::stamp);
    FoundIndex found{associate(depth, colour, within), source};
    if (found.lines.empty() && !depth.empty() && !colour.empty()) { // in another unit all are too far apart
        std::ostringstream why;
        why << ": depth and colour are at least " << nearestApart(depth, colour) << " apart, more than "
            << within << " (stamps are seconds)" << unitHint(depth);
        found.whyNone = why.str();
    }
    return found;
}

// A file whose name is that of an index in other words, "associate.txt"; empty = none.
std::string likeAssociations(const fs::path& folder) {
    std::string first;
    std::error_code failed;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, failed)) {
        const std::string name = entry.path().filename().string();
        const bool like = name.find("assoc") != std::string::npos && endingOf(entry.path()) == ".txt";
        first = like && (first.empty() || name < first) ? name : first;
    }
    return first;
}

FoundIndex findIndex(const fs::path& folder, const RecordingIntrinsics& intrinsics, bool depthOnly) {
    const bool hasDepth = fs::exists(folder / "depth.txt");
    if (!intrinsics.camera.hasColour) {
        return {withoutColour(readStampedFiles(folder, "depth.txt")), "depth.txt"};
    }
    if (fs::exists(folder / "associations.txt")) {
        return {readAssociations(folder), "associations.txt"};
    }
    if (depthOnly && hasDepth) {
        return {withoutColour(readStampedFiles(folder, "depth.txt")), "depth.txt"};
    }
    if (hasDepth && fs::exists(folder / "rgb.txt")) {
        return pairedByStamp(readStampedFiles(folder, "depth.txt"), readStampedFiles(folder, "rgb.txt"),
                             kTumTolerance, "rgb.txt and depth.txt");
    }
    if (depthOnly && !intrinsics.depthStamps.empty()) {
        return {withoutColour(stampedDepth(folder, intrinsics)), "depth_stamps_s"};
    }
    if (!intrinsics.depthStamps.empty() && !intrinsics.colourStamps.empty()) {
        return pairedByStamp(
            stampedDepth(folder, intrinsics),
            stampFilesOf(folder / "rgb", intrinsics.colourStamps, "color_stamps_s", kColourEndings),
            intrinsics.pairWithin, "depth_stamps_s and color_stamps_s");
    }
    const std::string other = likeAssociations(folder);
    throw BadInput(
        folder.string(), "associations.txt", other.empty() ? "missing" : "missing; " + other + " is there",
        "associations.txt, or rgb.txt and depth.txt, or stamps in intrinsics.json; or "
        "intrinsics=FILE after the folder name, also its own intrinsics.json, which pairs images by "
        "number; without colour depth.txt, and \"has_color\": false or colour=none after the "
        "folder name");
}

} // namespace

std::vector<IndexLine> readIndex(const fs::path& folder, const RecordingIntrinsics& intrinsics,
                                 bool depthOnly) {
    FoundIndex found = findIndex(folder, intrinsics, depthOnly);
    if (found.lines.empty()) {
        throw BadInput(folder.string(), found.source, "no pair of images" + found.whyNone, "at least one");
    }
    return std::move(found.lines);
}

} // namespace fathom
