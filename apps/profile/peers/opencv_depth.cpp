// SPDX-License-Identifier: Apache-2.0
// OpenCV: bilateralFilter on a depth image in float32 metres, and rgbd::depthTo3d on raw millimetres.
#include "apps/profile/peers/peers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <opencv2/rgbd.hpp>

namespace fathom::peers {

namespace {

// A pixel without a measurement is 0 for OpenCV, which treats it like any other depth.
class OpencvBilateral : public FilterPeer {
public:
    OpencvBilateral(uint32_t radius, double pixels, double metres, uint32_t threads)
        : radius_(radius)
        , pixels_(pixels)
        , metres_(metres)
        , threads_(threads) {}

    void load(const DepthImage& image) override {
        cv::setNumThreads(static_cast<int>(threads_));
        in_.create(static_cast<int>(image.lens.height), static_cast<int>(image.lens.width), CV_32FC1);
        std::transform(image.z.begin(), image.z.end(), in_.ptr<float>(),
                       [](float z) { return std::isnan(z) ? 0.0f : z; });
    }
    void run() override {
        cv::bilateralFilter(in_, out_, static_cast<int>(2 * radius_ + 1), metres_, pixels_);
    }
    std::vector<float> depths() const override {
        std::vector<float> z(in_.total());
        for (size_t i = 0; i < z.size(); ++i) {
            z[i] =
                in_.ptr<float>()[i] == 0.0f ? std::numeric_limits<float>::quiet_NaN() : out_.ptr<float>()[i];
        }
        return z;
    }

private:
    uint32_t radius_;
    double pixels_, metres_;
    uint32_t threads_;
    cv::Mat in_, out_;
};

class OpencvPoints : public PointPeer {
public:
    explicit OpencvPoints(uint32_t threads)
        : threads_(threads) {}

    void load(const Intrinsics& lens, std::span<const uint16_t> millimetres) override {
        cv::setNumThreads(static_cast<int>(threads_));
        lens_ = (cv::Mat_<float>(3, 3) << lens.fx, 0, lens.cx, 0, lens.fy, lens.cy, 0, 0, 1);
        in_.create(static_cast<int>(lens.height), static_cast<int>(lens.width), CV_16UC1);
        std::copy(millimetres.begin(), millimetres.end(), in_.ptr<uint16_t>());
    }
    void run() override { cv::rgbd::depthTo3d(in_, lens_, out_); }
    std::vector<dvec3> points() const override {
        std::vector<dvec3> all;
        for (auto at = out_.begin<cv::Vec3f>(); at != out_.end<cv::Vec3f>(); ++at) {
            all.emplace_back((*at)[0], (*at)[1], (*at)[2]);
        }
        return all;
    }

private:
    uint32_t threads_;
    cv::Mat lens_, in_, out_;
};

} // namespace

std::unique_ptr<FilterPeer> makeOpencvBilateral(uint32_t radius, double pixels, double metres,
                                                uint32_t threads) {
    return std::make_unique<OpencvBilateral>(radius, pixels, metres, threads);
}

std::unique_ptr<PointPeer> makeOpencvPoints(uint32_t threads) {
    return std::make_unique<OpencvPoints>(threads);
}

} // namespace fathom::peers
