// SPDX-License-Identifier: Apache-2.0
#include "devices/simulated/simulated_camera.h"

#include "engine/types/error.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/common.hpp>
#include <numbers>
#include <thread>

namespace fathom {

namespace {

constexpr uint32_t kRowsAtOnce = 8;
constexpr float kColourSigma = 1.3f; // [1/255] of the stored image
constexpr uint32_t kSnowflakes = 48; // a frame

// Calls work(row) for every row, shared out to `threads` threads in blocks.
template <class Work>
void forRows(uint32_t rows, uint32_t threads, const Work& work) {
    std::atomic<uint32_t> nextRow{0};
    const auto run = [&] {
        for (uint32_t first = nextRow.fetch_add(kRowsAtOnce); first < rows;
             first = nextRow.fetch_add(kRowsAtOnce)) {
            for (uint32_t row = first; row < std::min(rows, first + kRowsAtOnce); ++row) {
                work(row);
            }
        }
    };
    std::vector<std::jthread> others;
    for (uint32_t i = 1; i < threads; ++i) {
        others.emplace_back(run);
    }
    run();
}

SimulatedCameraOptions checked(SimulatedCameraOptions options) {
    if (options.width < 1 || options.width > 3840 || options.height < 1 || options.height > 2160) {
        throw Error("simulated camera: size must be 1..3840 x 1..2160");
    }
    if (options.threads < 1 || options.threads > 16 || !(options.focal >= 0.0) ||
        !(options.metresPerUnit > 0.0) || !(options.dropShare >= 0.0 && options.dropShare <= 1.0)) {
        throw Error("simulated camera: threads 1..16, focal >= 0, metres per unit > 0, drop share 0..1");
    }
    if (options.yuyv && options.width % 2 != 0) {
        throw Error("simulated camera: YUYV needs an even width");
    }
    options.focal = options.focal > 0.0 ? options.focal : options.width * 570.0 / 640.0;
    return options;
}

CameraInfo infoOf(const SimulatedCameraOptions& options) {
    CameraInfo info;
    info.depth.width = options.width;
    info.depth.height = options.height;
    info.depth.fx = info.depth.fy = options.focal;
    info.depth.cx = 0.5 * (options.width - 1.0);
    info.depth.cy = 0.5 * (options.height - 1.0);
    info.colour = info.depth;
    info.metresPerUnit = options.metresPerUnit;
    info.colourFormat = options.yuyv ? ColourFormat::Yuyv : ColourFormat::Rgba;
    return info;
}

uint32_t packed(uint32_t red, uint32_t green, uint32_t blue) {
    return 0xff000000u | blue << 16 | green << 8 | red;
}

} // namespace

SimulatedCamera::SimulatedCamera(AnalyticScene scene, SimulatedCameraOptions options)
    : options_(checked(options))
    , info_(infoOf(options_))
    , caster_(std::move(scene), options_.water)
    , slots_(info_.depth.pixels(), true, kFramesInFlight + 2)
    , nextFrame_(options_.firstFrame)
    , depth_(info_.depth.pixels())
    , solid_(info_.depth.pixels())
    , colour_(info_.depth.pixels()) {
    for (size_t i = 0; i < srgb_.size(); ++i) {
        const double linear = static_cast<double>(i) / 4095.0;
        const double s = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
        srgb_[i] = static_cast<uint8_t>(std::lround(255.0 * s));
    }
}

Pose SimulatedCamera::sceneTcamera(uint32_t frame) const {
    if (!options_.motion) {
        return {};
    }
    const double t = frame / kFrameRate;
    const auto sway = [t](double amplitude, double period) {
        return amplitude * std::sin(2.0 * std::numbers::pi * t / period);
    };
    const double degree = std::numbers::pi / 180.0;
    return {{sway(0.020, 9.0), sway(0.012, 7.0), sway(0.015, 13.0)},
            rotationExp({sway(1.2 * degree, 11.0), sway(-1.5 * degree, 8.0), sway(0.8 * degree, 10.0)})};
}

Pose SimulatedCamera::poseAt(uint32_t frame) const {
    return options_.baseTscene * sceneTcamera(frame);
}

void SimulatedCamera::showArm(std::span<const Sphere> spheres) {
    const Pose sceneTbase = inverse(options_.baseTscene);
    std::vector<Sphere> seen;
    for (const Sphere& s : spheres) {
        seen.push_back({sceneTbase.apply(s.centre), s.radius});
    }
    caster_.setVisitors(seen);
}

std::optional<Frame> SimulatedCamera::next() {
    if (nextFrame_ >= options_.frames) {
        return std::nullopt;
    }
    FrameSlot* slot = &slots_.acquireFor(description());
    const uint32_t frame = nextFrame_++;
    caster_.setView(sceneTcamera(frame), info_.depth);
    forRows(options_.height, options_.threads, [&](uint32_t row) { traceRow(row); });
    forRows(options_.height, options_.threads, [&](uint32_t row) { writeRow(row, frame, *slot); });
    if (options_.water && caster_.scene().underwater) {
        drawSnow(frame, *slot);
    }
    Frame::Content content;
    content.index = frame;
    content.sourceNumber = frame;
    content.captureTime = frame / kFrameRate;
    content.depth = slot->depth();
    content.colour = slot->colour();
    if (options_.yuyv) { // in place: a word comes no later than its two pixels
        const std::span<uint32_t> words = slot->colour().first(info_.depth.pixels() / 2);
        packYuyv(content.colour, words);
        content.raw = {info_.colourFormat, options_.width, options_.height, std::as_bytes(words)};
        content.colour = {};
    }
    content.baseTcamera = poseAt(frame);
    return slot->lend(content);
}

SimulatedCamera::ExactView SimulatedCamera::exactView(uint32_t frame) const {
    RayCaster caster = caster_;
    caster.setView(sceneTcamera(frame), info_.depth);
    ExactView view;
    for (uint32_t v = 0; v < options_.height; ++v) {
        for (uint32_t u = 0; u < options_.width; ++u) {
            const RayCaster::PixelHit pixel = caster.cast(u, v);
            view.depth.push_back(pixel.depth);
            view.solid.push_back(static_cast<int16_t>(pixel.hit.solid));
        }
    }
    return view;
}

// Light changes slowly over a surface: an odd pixel between two of its own solid takes their mean colour,
// which saves nearly half the lighting. Depth is traced for each pixel.
void SimulatedCamera::traceRow(uint32_t row) {
    const size_t first = size_t{row} * options_.width;
    RayCaster::PixelHit between; // of the odd pixel at hand
    for (uint32_t u = 0; u < options_.width; ++u) {
        const RayCaster::PixelHit hit = caster_.cast(u, row);
        const size_t pixel = first + u;
        depth_[pixel] = hit.depth;
        solid_[pixel] = static_cast<int16_t>(hit.hit.solid);
        if (u % 2 == 1 && u + 1 < options_.width) {
            between = hit;
            continue;
        }
        colour_[pixel] = caster_.colour(hit);
        if (u >= 2 && u % 2 == 0) {
            const bool alike = solid_[pixel] == solid_[pixel - 1] && solid_[pixel - 2] == solid_[pixel - 1];
            colour_[pixel - 1] =
                alike ? 0.5f * (colour_[pixel] + colour_[pixel - 2]) : caster_.colour(between);
        }
    }
}

void SimulatedCamera::writeRow(uint32_t row, uint32_t frame, FrameSlot& slot) const {
    for (uint32_t u = 0; u < options_.width; ++u) {
        const uint32_t pixel = row * options_.width + u;
        slot.depth()[pixel] = options_.noise ? sensedDepth(pixel, frame) : toUnits(depth_[pixel]);
        slot.colour()[pixel] = sensedColour(pixel, frame);
    }
}

uint16_t SimulatedCamera::toUnits(double depth) const {
    const double units = std::nearbyint(depth / options_.metresPerUnit);
    return units >= 1.0 && units <= 65535.0 ? static_cast<uint16_t>(units) : uint16_t{0};
}

double SimulatedCamera::acrossJump(uint32_t pixel) const {
    const uint32_t u = pixel % options_.width, v = pixel / options_.width;
    const double z = depth_[pixel];
    double across = 0.0, largest = kFlyingJump * z;
    const auto look = [&](bool there, uint32_t other) {
        if (there && depth_[other] > 0.0 && std::abs(depth_[other] - z) > largest) {
            across = depth_[other];
            largest = std::abs(depth_[other] - z);
        }
    };
    look(u > 0, pixel - 1);
    look(u + 1 < options_.width, pixel + 1);
    look(v > 0, pixel - options_.width);
    look(v + 1 < options_.height, pixel + options_.width);
    return across;
}

uint16_t SimulatedCamera::sensedDepth(uint32_t pixel, uint32_t frame) const {
    double z = depth_[pixel];
    const uint64_t bits = counterBits(options_.seed, frame, pixel, NoisePurpose::Depth);
    // The top bits draw the noise, the lowest 24 the dropout: they share no bit.
    if (z <= 0.0 || lowerUniform(bits) < options_.dropShare) {
        return 0;
    }
    if (const double across = acrossJump(pixel); across > 0.0) {
        const uint64_t flying = counterBits(options_.seed, frame, pixel, NoisePurpose::Flying);
        if (upperUniform(flying) < kFlyingShare) {
            z += static_cast<double>(lowerUniform(flying)) * (across - z);
        }
    }
    return toUnits(z + kDepthSigmaShare * depthSigma(z) * normal_(static_cast<uint32_t>(bits >> 44)));
}

// Where two solids meet, the mean of four rays in the pixel, as a sensor's pixel gathers light.
glm::vec3 SimulatedCamera::smoothColour(uint32_t pixel) const {
    const uint32_t u = pixel % options_.width, v = pixel / options_.width;
    const int16_t own = solid_[pixel];
    const bool alike = (u == 0 || solid_[pixel - 1] == own) &&
                       (v == 0 || solid_[pixel - options_.width] == own) &&
                       (u + 1 == options_.width || solid_[pixel + 1] == own) &&
                       (v + 1 == options_.height || solid_[pixel + options_.width] == own);
    if (alike) {
        return colour_[pixel];
    }
    glm::vec3 sum(0.0f);
    for (int sample = 0; sample < 4; ++sample) {
        const double du = sample & 1 ? 0.25 : -0.25, dv = sample & 2 ? 0.25 : -0.25;
        sum += glm::min(caster_.colour(caster_.cast(u + du, v + dv)), glm::vec3(1.0f));
    }
    return 0.25f * sum;
}

uint32_t SimulatedCamera::sensedColour(uint32_t pixel, uint32_t frame) const {
    const glm::vec3 colour = smoothColour(pixel);
    std::array<float, 3> stored{};
    for (int i = 0; i < 3; ++i) {
        stored[i] = srgb_[static_cast<size_t>(std::min(colour[i], 1.0f) * 4095.0f + 0.5f)] + 0.5f;
    }
    if (options_.noise) {
        uint64_t bits = counterBits(options_.seed, frame, pixel, NoisePurpose::Colour);
        for (float& channel : stored) {
            channel = std::clamp(channel + kColourSigma * normal_.coarse(static_cast<uint32_t>(bits)), 0.0f,
                                 255.0f);
            bits >>= 20;
        }
    }
    return packed(static_cast<uint32_t>(stored[0]), static_cast<uint32_t>(stored[1]),
                  static_cast<uint32_t>(stored[2]));
}

// Marine snow: grey specks of one or two pixels close to the lens, in other places in every frame.
void SimulatedCamera::drawSnow(uint32_t frame, FrameSlot& slot) const {
    for (uint32_t flake = 0; flake < kSnowflakes; ++flake) {
        const uint64_t place = counterBits(options_.seed, frame, flake, NoisePurpose::Snow);
        const uint64_t look = counterBits(options_.seed, frame, kSnowflakes + flake, NoisePurpose::Snow);
        const double z = 0.15 + 0.45 * upperUniform(look);
        const auto u = static_cast<uint32_t>(upperUniform(place) * static_cast<float>(options_.width));
        const auto v = static_cast<uint32_t>(lowerUniform(place) * static_cast<float>(options_.height));
        const auto grey = static_cast<uint32_t>(130.0f + 90.0f * lowerUniform(look));
        const uint32_t length = 1 + static_cast<uint32_t>(look >> 30 & 1u);
        for (uint32_t x = u; x < std::min(u + length, options_.width); ++x) {
            const size_t pixel = size_t{v} * options_.width + x;
            if (depth_[pixel] == 0.0 || z < depth_[pixel]) {
                slot.depth()[pixel] = toUnits(z);
                slot.colour()[pixel] = packed(grey - 12, grey, grey);
            }
        }
    }
}

} // namespace fathom
