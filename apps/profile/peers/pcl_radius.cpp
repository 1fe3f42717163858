// SPDX-License-Identifier: Apache-2.0
// PCL: a kd-tree (FLANN) over the centres, with one radius search per leaf. Unsorted results, its faster
// mode.
#include "apps/profile/peers/found_set.h"
#include "apps/profile/peers/peers.h"

#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_types.h>

namespace fathom::peers {

namespace {

class PclRadius : public CollisionPeer {
public:
    void build(const RegionSpheres& spheres) override {
        spheres_ = &spheres;
        radius_ = largestRadius(spheres);
        tree_.reset();
        if (spheres.size() == 0) {
            return; // the tree rejects an empty cloud
        }
        const auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
        cloud->reserve(spheres.size());
        for (size_t i = 0; i < spheres.size(); ++i) {
            cloud->emplace_back(spheres.x[i], spheres.y[i], spheres.z[i]);
        }
        tree_ = std::make_unique<pcl::KdTreeFLANN<pcl::PointXYZ>>(false);
        tree_->setInputCloud(cloud);
    }

    void query(const PosedLeaves& leaves, float reach, std::vector<uint32_t>& found) override {
        found.clear();
        found_.begin(spheres_->size());
        for (size_t l = 0; tree_ && l < leaves.x.size(); ++l) {
            const float limit = reach + leaves.radius[l];
            const pcl::PointXYZ at(leaves.x[l], leaves.y[l], leaves.z[l]);
            // Searches slightly wider because the tree compares rounded squares; the exact test follows.
            tree_->radiusSearch(at, (limit + radius_) * 1.00001, near_, squares_);
            for (const auto i : near_) {
                found_.test(*spheres_, static_cast<uint32_t>(i), at.x, at.y, at.z, limit, found);
            }
        }
    }

private:
    const RegionSpheres* spheres_ = nullptr;
    float radius_ = 0.0f;
    std::unique_ptr<pcl::KdTreeFLANN<pcl::PointXYZ>> tree_;
    pcl::Indices near_;
    std::vector<float> squares_;
    FoundSet found_;
};

} // namespace

std::unique_ptr<CollisionPeer> makePclRadius() {
    return std::make_unique<PclRadius>();
}

} // namespace fathom::peers
