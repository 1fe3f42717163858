// SPDX-License-Identifier: Apache-2.0
// PCL: FastBilateralFilterOMP on an organised cloud. Its bilateral grid approximates the Gaussian in image
// and depth, without a window. It fills in depths without a measurement; depths() removes these.
#include "apps/profile/peers/peers.h"

#include <cmath>
#include <limits>
#include <pcl/filters/fast_bilateral_omp.h>
#include <pcl/point_types.h>

namespace fathom::peers {

namespace {

class PclBilateral : public FilterPeer {
public:
    PclBilateral(double pixels, double metres, uint32_t threads)
        : filter_(threads) {
        filter_.setSigmaS(static_cast<float>(pixels));
        filter_.setSigmaR(static_cast<float>(metres));
    }

    void load(const DepthImage& image) override {
        const Intrinsics& lens = image.lens;
        cloud_ = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>(lens.width, lens.height);
        cloud_->is_dense = false;
        for (uint32_t i = 0; i < lens.pixels(); ++i) {
            const float z = image.z[i];
            const glm::dvec2 ray = lens.ray(i % lens.width, i / lens.width);
            (*cloud_)[i] = {static_cast<float>(ray.x) * z, static_cast<float>(ray.y) * z, z};
        }
        filter_.setInputCloud(cloud_);
    }
    void run() override { filter_.filter(out_); }
    std::vector<float> depths() const override {
        std::vector<float> z;
        for (size_t i = 0; i < out_.size(); ++i) {
            z.push_back(std::isnan((*cloud_)[i].z) ? std::numeric_limits<float>::quiet_NaN() : out_[i].z);
        }
        return z;
    }

private:
    pcl::FastBilateralFilterOMP<pcl::PointXYZ> filter_;
    pcl::PointCloud<pcl::PointXYZ>::Ptr cloud_;
    pcl::PointCloud<pcl::PointXYZ> out_;
};

} // namespace

std::unique_ptr<FilterPeer> makePclBilateral(double pixels, double metres, uint32_t threads) {
    return std::make_unique<PclBilateral>(pixels, metres, threads);
}

} // namespace fathom::peers
