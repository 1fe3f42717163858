// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/topic_words.h"

#include "engine/types/lower_case.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

namespace fathom {

namespace {

constexpr std::array<std::string_view, 3> kDepthWords{"depth", "range", "distance"};
constexpr std::array<std::string_view, 3> kColourWords{"rgb", "color", "colour"};
constexpr std::array<std::string_view, 35> kInfraredWords{
    "ir",         "infra",       "infrared", "nir",          "nearir",    "lwir",         "thermal",
    "flir",       "lepton",      "boson",    "seek",         "intensity", "amplitude",    "brightness",
    "confidence", "disparity",   "reflec",   "reflectivity", "signal",    "reflectance",  "ambient",
    "noise",      "uncertainty", "variance", "temperature",  "label",     "segmentation", "semantic",
    "mask",       "instances",   "gray",     "grey",         "mono",      "fisheye",      "phase"};
constexpr std::array<std::string_view, 31> kAuxiliaryWords{"error",
                                                           "err",
                                                           "std",
                                                           "stddev",
                                                           "sigma",
                                                           "snr",
                                                           "quality",
                                                           "cost",
                                                           "costmap",
                                                           "elevation",
                                                           "height",
                                                           "normal",
                                                           "normals",
                                                           "surface",
                                                           "validity",
                                                           "age",
                                                           "seg",
                                                           "instance",
                                                           "detection",
                                                           "detections",
                                                           "overlay",
                                                           "panoptic",
                                                           "classes",
                                                           "heatmap",
                                                           "depthvis",
                                                           "disparitynormalized",
                                                           "surfacenormals",
                                                           "invdepth",
                                                           "idepth",
                                                           "inversedepth",
                                                           "logdepth"};
// Behind a word of depth alone: cameras and computers are called edge, too.
constexpr std::array<std::string_view, 18> kDerivedWords{
    "gradient", "grad",       "laplacian",   "derivative", "curvature",   "residual",
    "diff",     "difference", "weight",      "prob",       "probability", "likelihood",
    "entropy",  "score",      "reliability", "edge",       "contour",     "flow"};
constexpr std::array<std::string_view, 8> kUnscaledWords{"inverse",    "inv",        "log",  "relative",
                                                         "normalized", "normalised", "norm", "unscaled"};
constexpr std::array<std::string_view, 4> kPaintedWords{"colored", "coloured", "colorized", "colourized"};
// Not in the first of several parts. "ab" is active brightness, "disp" disparity.
constexpr std::array<std::string_view, 1> kLaterDepthWords{"z"};
constexpr std::array<std::string_view, 3> kLaterPaintedWords{"colormap", "colourmap", "jet"};
constexpr std::array<std::string_view, 6> kLaterAuxiliaryWords{"ab",    "conf", "disp",
                                                               "class", "ids",  "events"};

template <size_t N>
bool among(const std::array<std::string_view, N>& words, const std::string& word) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

std::string singularOf(const std::string& word) {
    constexpr size_t kShortest = 4;
    if (word.size() < kShortest || word.back() != 's') {
        return word;
    }
    return word.ends_with("ies") ? word.substr(0, word.size() - 3) + "y" : word.substr(0, word.size() - 1);
}

WordUse useAlone(const std::string& word, bool firstPart) {
    const bool later = !firstPart;
    if (among(kDepthWords, word) || (later && among(kLaterDepthWords, word))) {
        return WordUse::Depth;
    }
    if (among(kPaintedWords, word) || (later && among(kLaterPaintedWords, word))) {
        return WordUse::Painted;
    }
    if (among(kColourWords, word)) {
        return WordUse::Colour;
    }
    if (among(kInfraredWords, word)) {
        return WordUse::Infrared;
    }
    if (among(kAuxiliaryWords, word) || (later && among(kLaterAuxiliaryWords, word))) {
        return WordUse::Auxiliary;
    }
    return among(kDerivedWords, word)    ? WordUse::Derived
           : among(kUnscaledWords, word) ? WordUse::Unscaled
                                         : WordUse::None;
}

bool isUpper(char c) {
    return std::isupper(static_cast<unsigned char>(c)) != 0;
}

bool isLower(char c) {
    return std::islower(static_cast<unsigned char>(c)) != 0;
}

bool isDigit(char c) {
    return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

// Whether a word of camel case begins at a character after the first: "ir|Image", "IR|Image", "cam2|RGB".
bool beginsCamelWord(const std::string& text, size_t at) {
    const char before = text[at - 1];
    const bool last = at + 1 == text.size();
    return isUpper(text[at]) &&
           (isLower(before) || isDigit(before) || (isUpper(before) && !last && isLower(text[at + 1])));
}

// In the case of the name.
std::vector<std::string> casedTokensOf(const std::string& name) {
    std::vector<std::string> tokens;
    bool open = false;
    for (const char c : name) {
        const bool letter = std::isalnum(static_cast<unsigned char>(c)) != 0;
        if (letter && !open) {
            tokens.emplace_back();
        }
        if (letter) {
            tokens.back() += c;
        }
        open = letter;
    }
    return tokens;
}

} // namespace

WordUse useOf(const std::string& word, bool firstPart) {
    const WordUse use = useAlone(word, firstPart);
    return use == WordUse::None ? useAlone(singularOf(word), firstPart) : use;
}

bool isUsualWord(const std::string& word) {
    constexpr std::array<std::string_view, 20> kUsual{
        "image",      "images",  "img",  "raw", "rect",   "rectified", "undistorted",
        "registered", "aligned", "data", "map", "hw",     "sw",        "frame",
        "stream",     "optical", "to",   "in",  "camera", "cam"};
    return isDigit(word.front()) || useOf(word, false) != WordUse::None || among(kUsual, word);
}

bool endsCamera(const std::string& word) {
    constexpr std::array<std::string_view, 5> kCameras{"camera", "cam", "sensor", "ai", "sense"};
    return among(kCameras, word);
}

bool describesImages(const std::vector<std::string>& words, size_t at) {
    const bool denied = at > 0 && (words[at - 1] == "without" || words[at - 1] == "no");
    const auto rest = words.begin() + static_cast<std::ptrdiff_t>(at) + 1;
    const bool participle = rest != words.end() && *rest == "aligned";
    return !denied && !participle && std::all_of(rest, words.end(), [](const std::string& word) {
        return isUsualWord(word) && !endsCamera(word);
    });
}

std::vector<std::string> tokensOf(const std::string& name) {
    std::vector<std::string> tokens = casedTokensOf(name);
    std::ranges::transform(tokens, tokens.begin(), lowerCase);
    return tokens;
}

std::vector<std::string> camelWordsOf(const std::string& name) {
    std::vector<std::string> words;
    for (const std::string& token : casedTokensOf(name)) {
        words.push_back(lowerCase(token));
        if (useOf(words.back(), false) != WordUse::None) {
            continue;
        }
        words.back().clear();
        for (size_t i = 0; i < token.size(); ++i) {
            if (i > 0 && beginsCamelWord(token, i)) {
                words.emplace_back();
            }
            words.back() += lowerCase(std::string(1, token[i]));
        }
    }
    return words;
}

std::vector<std::string> withoutDigits(std::vector<std::string> words) {
    for (std::string& word : words) {
        while (word.size() > 1 && isDigit(word.back())) {
            word.pop_back();
        }
    }
    return words;
}

} // namespace fathom
