// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/foreign_field.h"

#include "devices/recorded/name_words.h"
#include "devices/recorded/source_options.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <vector>

namespace fathom {

namespace {

// Names by which other programs store the same value, or all four of a pinhole.
struct ForeignName {
    const char *own, *other, *allowed;
};
constexpr const char* kFourNumbers =
    "fx, fy, cx and cy, each under its name, or \"intrinsic_matrix\" column by column";
constexpr const char* kTopLevel = "width, height, fx, fy, cx and cy at the top level of the file";
constexpr std::array kForeignNames{ForeignName{"width", "w", "the name width"},
                                   ForeignName{"width", "image_width", "the name width"},
                                   ForeignName{"width", "camera", kTopLevel},
                                   ForeignName{"width", "intrinsics", kTopLevel},
                                   ForeignName{"height", "h", "the name height"},
                                   ForeignName{"height", "image_height", "the name height"},
                                   ForeignName{"fx", "fl_x", "the name fx"},
                                   ForeignName{"fy", "fl_y", "the name fy"},
                                   ForeignName{"cx", "ppx", "the name cx"},
                                   ForeignName{"cy", "ppy", "the name cy"},
                                   ForeignName{"fx", "K", kFourNumbers},
                                   ForeignName{"fx", "cam_K", kFourNumbers},
                                   ForeignName{"fx", "camera_matrix", kFourNumbers},
                                   ForeignName{"fx", "k", kFourNumbers},
                                   ForeignName{"fx", "matrix", kFourNumbers},
                                   ForeignName{"fx", "intrinsics", kFourNumbers},
                                   ForeignName{"fx", "intrinsic", kFourNumbers},
                                   ForeignName{"fx", "f_x", "the name fx"},
                                   ForeignName{"fx", "f", kFourNumbers},
                                   ForeignName{"fx", "focal", kFourNumbers},
                                   ForeignName{"fx", "focal_length", kFourNumbers}};

constexpr const char *kCoefficients = "distortion", *kModel = "distortion_model";

// Letters in lower case, and digits: "depthScale" and "Depth_Scale" are one name.
std::string plainLetters(std::string_view name) {
    std::string plain;
    for (const char c : name) {
        if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
            plain += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        }
    }
    return plain;
}

template <size_t N>
bool isAny(const std::string& text, const std::array<std::string_view, N>& words) {
    return std::ranges::find(words, text) != words.end();
}

// Of distortion alone: "distorsion", "disto_k3", "radialDistortion", "distcoeffs".
bool isDistortionWord(std::string_view word) {
    return word.starts_with("disto") || word.starts_with("distpar") ||
           word.find("distort") != std::string_view::npos || word.find("distcoef") != std::string_view::npos;
}

// Alone or together, or "dist" with one of them: water has coefficients, too, and points have a
// radial accuracy.
bool areCoefficientWords(const std::vector<std::string>& words) {
    constexpr std::array<std::string_view, 5> kDistortion{"dist", "lensdist", "radial", "tangential",
                                                          "prism"};
    constexpr std::array<std::string_view, 6> kCoefficientWords{"coef",   "coefs",       "coeff",
                                                                "coeffs", "coefficient", "coefficients"};
    constexpr std::array<std::string_view, 4> kParameters{"param", "params", "parameter", "parameters"};
    constexpr std::array<std::string_view, 8> kNeutralWords{"lens",  "thin",    "k",      "p",
                                                            "brown", "conrady", "opencv", ""};
    bool named = false, listed = false, dist = false, other = false;
    for (const std::string& word : words) {
        const std::string plain = word.substr(0, word.find_last_not_of("0123456789") + 1);
        const bool coefficients = isAny(plain, kCoefficientWords), parameters = isAny(plain, kParameters);
        named = named || coefficients || isAny(plain, kDistortion);
        listed = listed || coefficients || parameters;
        dist = dist || plain == "dist";
        other = other ||
                !(coefficients || parameters || isAny(plain, kDistortion) || isAny(plain, kNeutralWords));
    }
    return (named && !other) || (dist && listed);
}

bool namesCoefficients(const JsonField& block, const std::string& key) {
    constexpr std::array<std::string_view, 4> kWhole{"d", "kc", "k0", "xi"};
    const std::string plain = plainLetters(key);
    const std::vector<std::string> words = nameWords(key);
    const bool single = plain.size() == 2 && (plain[0] == 'k' || plain[0] == 'p') && plain[1] >= '1' &&
                        plain[1] <= '6'; // k1 to k6, p1 and p2
    const bool kappa = plain.find("kappa") != std::string::npos && !block.find("omega"); // else angles
    return key != kCoefficients && (single || kappa || isAny(plain, kWhole) || areCoefficientWords(words) ||
                                    std::ranges::any_of(words, isDistortionWord));
}

// Lists of any lens: coefficients where they hold a number below 1 that is not of the pinhole. Others may be
// the pinhole of another image size. 9 are a matrix, and one may be anything but for "k".
bool listsCoefficients(const JsonField& block, const std::string& key) {
    constexpr std::array<std::string_view, 5> kLists{"k", "params", "parameters", "lensparams",
                                                     "lensparameters"};
    constexpr std::array<std::string_view, 4> kPinhole{"fx", "fy", "cx", "cy"};
    constexpr double kPrinted = 0.01; // relative
    const JsonField list = block.at(key);
    const std::string plain = plainLetters(key);
    if (!isAny(plain, kLists) || !(list.isNumber() || list.isNumbers())) {
        return false;
    }
    const std::vector<double> values = list.isNumber() ? std::vector{list.finite()} : list.numbers();
    const auto coefficient = [&](double value) {
        return value != 0.0 && std::abs(value) < 1.0 &&
               std::ranges::none_of(kPinhole, [&](std::string_view name) {
                   const auto own = block.find(name);
                   return own && own->isNumber() && std::abs(own->finite() - value) < kPrinted * value;
               });
    };
    return values.size() != 9 && (values.size() != 1 || plain == "k") &&
           std::ranges::any_of(values, coefficient);
}

// Of fisheyes and the like, whose rays bend also where all coefficients are zero.
bool namesBentLens(const std::string& model) {
    constexpr std::array<std::string_view, 8> kParts{"fisheye",      "equidistant", "kannala",
                                                     "omnidir",      "equisolid",   "stereographic",
                                                     "doublesphere", "scaramuzza"};
    // OmniVision is a maker of sensors.
    constexpr std::array<std::string_view, 7> kWhole{"omni", "mei", "ucm", "eucm", "fov", "kb4", "kb8"};
    const std::string plain = plainLetters(model);
    return containsAny(plain, kParts) || isAny(plain, kWhole);
}

constexpr const char* kBentAllowed =
    "a pinhole, or the coefficients as a list \"distortion\" with \"distortion_model\"";

void refuseBentModel(const JsonField& block) {
    const auto list = block.find(kCoefficients);
    const bool given = list && !list->isNothing();
    for (const std::string& key : block.keys()) {
        const std::string plain = plainLetters(key);
        const bool model = plain.find("model") != std::string::npos || plain.ends_with("type");
        const bool read = given && block.find(kModel);
        if (block.at(key).isTrue() && !read && namesBentLens(key)) {
            block.at(key).refuse(kBentAllowed);
        }
        if (const JsonField field = block.at(key); model && !read && field.isText() &&
                                                   namesBentLens(field.text()) &&
                                                   !(key == kModel && list && !list->isEmpty())) {
            field.refuse(kBentAllowed);
        }
    }
}

constexpr const char* kOwnScale = "depth_scale_m_per_unit";

bool namesDepth(const std::string& key) {
    return plainLetters(key).find("depth") != std::string::npos;
}

bool namesScale(const std::string& key) {
    constexpr std::array<std::string_view, 7> kKinds{"scale", "factor",  "unit",      "shift",
                                                     "divi",  "multipl", "resolution"};
    constexpr std::array<std::string_view, 7> kWhole{"scale",  "scalefactor", "unit",      "units",
                                                     "zscale", "meterscale",  "metrescale"};
    constexpr std::array<std::string_view, 8> kRates{"permetre", "permeter", "metresper", "metersper",
                                                     "metreper", "meterper", "tometre",   "tometer"};
    const std::string plain = plainLetters(key);
    const bool rate = containsAny(plain, kRates) && plain.find("pixel") == std::string::npos;
    return key != kOwnScale &&
           (isAny(plain, kWhole) || rate || (namesDepth(key) && containsAny(plain, kKinds)));
}

// Of noise, or in another unit than metres.
bool isNoMetres(const std::vector<std::string>& words) {
    constexpr std::array<std::string_view, 5> kNoise{"noise", "sigma", "error", "micro", "percent"};
    return std::ranges::any_of(words, [&](const std::string& word) {
        return word == "um" || word == "mm" || containsAny(word, kNoise);
    });
}

// A field that by its name is a depth scale.
struct NamedScale {
    JsonField field;
    std::string plain; // letters of its key
    bool ofDepth;      // surely: also images and worlds have a scale
    bool metres;       // or units per metre, by its name
};

std::vector<NamedScale> namedScales(const JsonField& root) {
    std::vector<JsonField> blocks{root};
    for (const std::string& key : root.keys()) {
        if (namesDepth(key)) { // its own fields, if it has some
            blocks.push_back(root.at(key));
        }
    }
    std::vector<NamedScale> all;
    for (const JsonField& block : blocks) {
        const bool inner = &block != &blocks.front();
        for (const std::string& key : block.keys()) {
            if (namesScale(key) || (inner && key == kOwnScale)) {
                all.push_back({block.at(key), plainLetters(key), inner || namesDepth(key),
                               !isNoMetres(nameWords(key))});
            }
        }
    }
    return all;
}

// Or nothing of depth: 1 is one unit of the images' values.
bool isMillimetres(const JsonField& scale) {
    constexpr std::array<std::string_view, 8> kTexts{"mm",         "millimetre",  "millimetres",
                                                     "millimeter", "millimeters", "px",
                                                     "pixel",      "pixels"}; // the lens's unit
    constexpr std::array kNumbers{0.001, 1.0, 1000.0};
    if (scale.isText()) {
        return isAny(plainLetters(scale.text()), kTexts);
    }
    return scale.isNothing() || std::ranges::any_of(kNumbers, [&](double one) { return scale.is(one); });
}

} // namespace

JsonField ownField(const JsonField& block, std::string_view name) {
    if (const auto own = block.find(name)) {
        return *own;
    }
    for (const ForeignName& foreign : kForeignNames) {
        if (const auto other = foreign.own == name ? block.find(foreign.other) : std::nullopt) {
            other->refuse(foreign.allowed);
        }
    }
    return block.at(name);
}

void refuseForeignDistortion(const JsonField& block) {
    const bool own = block.find(kCoefficients).has_value();
    for (const std::string& key : block.keys()) {
        const bool named = !own && (namesCoefficients(block, key) || listsCoefficients(block, key));
        if (named && !block.at(key).isNothing()) {
            block.at(key).refuse(
                "zeros, or the coefficients as a list \"distortion\" with \"distortion_model\"");
        }
    }
    refuseBentModel(block);
}

void refuseSharedDistortion(const JsonField& root, const JsonField& depth, const JsonField& colour) {
    if (depth.find(kCoefficients) && colour.find(kCoefficients)) {
        return;
    }
    if (const auto list = root.find(kCoefficients); list && !list->isNothing()) {
        list->refuse("\"distortion\" in each of the blocks depth and color");
    }
    refuseForeignDistortion(root);
}

std::optional<JsonField> foreignScale(const JsonField& root) {
    for (const NamedScale& scale : namedScales(root)) {
        const bool size = scale.plain.find("resolution") != std::string::npos && !scale.field.isNumber();
        if (!size && !isMillimetres(scale.field)) {
            return scale.field;
        }
    }
    return std::nullopt;
}

std::optional<OtherUnit> otherUnit(const JsonField& root, double unit) {
    constexpr double kRounded = 0.01;
    for (const NamedScale& scale : namedScales(root)) {
        const double value =
            scale.ofDepth && scale.metres && scale.field.isNumber() ? scale.field.finite() : 0.0;
        // "depth_resolution" may be a width, and "depth_shift" a distance.
        const bool size = scale.plain.find("resolution") != std::string::npos,
                   shift = scale.plain.find("shift") != std::string::npos;
        const bool metres = value >= kFinestUnit && value <= kCoarsestUnit && !shift,
                   perMetre = value >= 1.0 / kCoarsestUnit && value <= 1.0 / kFinestUnit && !size;
        const double other = metres ? value : perMetre ? 1.0 / value : unit;
        if (std::abs(other - unit) > kRounded * unit) {
            return OtherUnit{scale.field, other};
        }
    }
    return std::nullopt;
}

} // namespace fathom
