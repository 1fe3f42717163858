// SPDX-License-Identifier: Apache-2.0
#include "apps/inspect/frame_study.h"

#include "apps/output/image.h"
#include "apps/output/output_folder.h"
#include "engine/types/colour_copy.h"
#include "engine/types/printed.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <numeric>
#include <ostream>

namespace fathom {

namespace {

constexpr int kBars = 12, kLongestBar = 40;

std::string fixed(double value, int digits) {
    return printed("%.*f", digits, value);
}

bool isGrey(uint32_t rgba) {
    const auto [least, most] = std::minmax({rgba & 255, rgba >> 8 & 255, rgba >> 16 & 255});
    return 10 * (most - least) <= most;
}

template <class Pixel> // Pixel(i): 0xAARRGGBB
void savePicture(const Intrinsics& size, const std::filesystem::path& file, Pixel&& pixel) {
    const Image image(static_cast<int>(size.width), static_cast<int>(size.height), {});
    image.beginPixels();
    for (uint32_t v = 0; v < size.height; ++v) {
        for (uint32_t u = 0; u < size.width; ++u) {
            image.row(static_cast<int>(v))[u] = 0xff000000u | pixel(v * size.width + u);
        }
    }
    image.endPixels();
    image.writePng(file);
}

// Near is light: grey is inverse depth between the extremes of the image.
void saveDepth(const Frame& frame, const CameraInfo& info, const std::filesystem::path& file) {
    uint16_t least = 65535, most = 1;
    for (const uint16_t raw : frame->depth) {
        least = raw > 0 ? std::min(least, raw) : least;
        most = std::max(most, raw);
    }
    const double far = least < most ? 1.0 / most : 0.0, span = 1.0 / least - far;
    savePicture(info.depth, file, [&](size_t i) {
        const uint16_t raw = frame->depth[i];
        const double share = raw == 0 ? -1.0 : (1.0 / raw - far) / span;
        const auto level = static_cast<uint32_t>(share < 0.0 ? 0.0 : 30.0 + 225.0 * share);
        return level * 0x010101u;
    });
}

void saveColour(const Frame& frame, const CameraInfo& info, const std::filesystem::path& file) {
    const std::vector<uint32_t> colours = coloursOf(*frame);
    savePicture(info.colour, file, [&](size_t i) {
        const uint32_t c = colours[i];
        return (c & 255) << 16 | (c & 0xff00) | (c >> 16 & 255);
    });
}

} // namespace

FrameStudy::FrameStudy(Camera& camera, const std::optional<std::filesystem::path>& out)
    : info_(camera.info())
    , frameCount_(camera.frameCount())
    , live_(camera.live())
    , noColour_(camera.whyNoColour()) {
    while (auto frame = camera.next()) {
        if (stamps_.size() == kMaxFrames) {
            more_ = true;
            break;
        }
        if (stamps_.empty() && out) {
            makeOutputFolder(*out);
            saveDepth(*frame, info_, *out / "depth.png");
            if (info_.hasColour) {
                saveColour(*frame, info_, *out / "colour.png");
            }
        }
        add(*frame);
    }
    skipped_ = camera.skipped();
    measured_ = std::accumulate(counts_.begin() + 1, counts_.end(), uint64_t{0});
    if (out && !stamps_.empty()) {
        drawHistograms(depthBars(), info_.hasColour ? &hues_ : nullptr, *out / "histograms.png");
    }
}

void FrameStudy::add(const Frame& frame) {
    for (const uint16_t raw : frame->depth) {
        ++counts_[raw];
    }
    if (info_.hasColour && stamps_.size() % 30 == 0) {
        const std::vector<uint32_t> colours = coloursOf(*frame);
        for (const uint32_t rgba : colours) {
            ++(isGrey(rgba) ? grey_ : coloured_);
        }
        hues_.add(colours);
    }
    stamps_.push_back(frame->captureTime);
    posed_ += frame->baseTcamera ? 1 : 0;
}

void FrameStudy::writeTimes(std::ostream& out) const {
    out << "frames    " << stamps_.size() << " read" << (more_ ? ", the first ones" : "")
        << (frameCount_ > 0 ? " of " + std::to_string(frameCount_) : "") << "; " << skipped_ << " skipped; "
        << posed_ << " with the camera's pose\n";
    if (stamps_.size() < 2) {
        return;
    }
    double longest = 0.0, at = 0.0;
    for (size_t i = 1; i < stamps_.size(); ++i) {
        const double gap = stamps_[i] - stamps_[i - 1];
        at = gap > longest ? stamps_[i - 1] - stamps_.front() : at;
        longest = std::max(longest, gap);
    }
    const double span = stamps_.back() - stamps_.front();
    out << "clock     from " << fixed(stamps_.front(), 3) << " s, " << fixed(span, 3) << " s long";
    if (span > 0.0) {
        out << ", " << fixed(static_cast<double>(stamps_.size() - 1) / span, 2) << " frames/s; longest gap "
            << fixed(longest, 3) << " s, after " << fixed(at, 3) << " s";
    }
    out << (live_ ? " (monotonic clock)\n" : "\n");
}

double FrameStudy::quantile(double share) const {
    auto left = static_cast<uint64_t>(share * static_cast<double>(measured_ - 1));
    size_t raw = 1;
    for (; counts_[raw] <= left; ++raw) {
        left -= counts_[raw];
    }
    return static_cast<double>(raw) * info_.metresPerUnit;
}

DepthBars FrameStudy::depthBars() const {
    if (measured_ == 0) {
        return {};
    }
    DepthBars bars;
    bars.low = quantile(0.0);
    bars.width = std::max((quantile(0.99) - bars.low) / kBars, info_.metresPerUnit);
    bars.counts.resize(kBars + 1); // the last one: beyond
    for (size_t raw = 1; raw < counts_.size(); ++raw) {
        const double bar = (static_cast<double>(raw) * info_.metresPerUnit - bars.low) / bars.width;
        bars.counts[static_cast<size_t>(std::clamp(bar, 0.0, double{kBars}))] += counts_[raw];
    }
    return bars;
}

void FrameStudy::writeDepth(std::ostream& out) const {
    const uint64_t all = measured_ + counts_[0];
    out << "depth     "
        << fixed(all > 0 ? 100.0 * static_cast<double>(measured_) / static_cast<double>(all) : 0.0, 1)
        << " % of the pixels measured";
    if (measured_ == 0) {
        out << "\n";
        return;
    }
    out << "; " << fixed(quantile(0.0), 3) << " m nearest, " << fixed(quantile(0.5), 3) << " m median, "
        << fixed(quantile(1.0), 3) << " m farthest\n";
    const DepthBars bars = depthBars();
    const uint64_t most = *std::max_element(bars.counts.begin(), bars.counts.end());
    for (size_t i = 0; i < bars.counts.size(); ++i) {
        const auto length = static_cast<size_t>(
            std::ceil(kLongestBar * static_cast<double>(bars.counts[i]) / static_cast<double>(most)));
        out << "  " << std::setw(9) << fixed(bars.low + bars.width * static_cast<double>(i), 3) << " m  "
            << std::string(length, '#') << "\n";
    }
}

void FrameStudy::writeColour(std::ostream& out) const {
    if (!info_.hasColour) {
        out << "colour    none: " << noColour_ << "; gates of hue and saturation select nothing\n";
        return;
    }
    const double all = static_cast<double>(grey_ + coloured_);
    out << "colour    " << fixed(all > 0.0 ? 100.0 * static_cast<double>(coloured_) / all : 0.0, 1)
        << " % of the pixels have a saturation over 0.1" << (noColour_.empty() ? "" : "; " + noColour_)
        << "\n";
    hues_.write(out);
}

void FrameStudy::write(std::ostream& out) const {
    writeTimes(out);
    writeDepth(out);
    writeColour(out);
}

} // namespace fathom
