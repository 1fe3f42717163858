// SPDX-License-Identifier: Apache-2.0
// FCL: a dynamic box tree (its recommended broad phase) over the spheres, with one collide() per leaf and the
// exact test in the callback.
#include "apps/profile/peers/found_set.h"
#include "apps/profile/peers/peers.h"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision_object.h>

namespace fathom::peers {

namespace {

struct FclQuery {
    const RegionSpheres* spheres;
    FoundSet* set;
    std::vector<uint32_t>* found;
    const fcl::CollisionObjectd* leaf;
    float x, y, z, limit;
};

bool visit(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data) {
    const auto& query = *static_cast<const FclQuery*>(data);
    const fcl::CollisionObjectd* sphere = a == query.leaf ? b : a;
    const auto i = static_cast<uint32_t>(reinterpret_cast<uintptr_t>(sphere->getUserData()));
    query.set->test(*query.spheres, i, query.x, query.y, query.z, query.limit, *query.found);
    return false; // continue
}

class FclTree : public CollisionPeer {
public:
    void build(const RegionSpheres& spheres) override {
        spheres_ = &spheres;
        manager_ = std::make_unique<fcl::DynamicAABBTreeCollisionManagerd>();
        objects_.clear();
        objects_.reserve(spheres.size());
        std::vector<fcl::CollisionObjectd*> all;
        std::shared_ptr<fcl::Sphered> shape;
        for (size_t i = 0; i < spheres.size(); ++i) {
            const double radius = spheres.radius[i];
            if (!shape || shape->radius != radius) { // equal spheres share one shape
                shape = std::make_shared<fcl::Sphered>(radius);
            }
            fcl::Transform3d pose = fcl::Transform3d::Identity();
            pose.translation() = fcl::Vector3d(spheres.x[i], spheres.y[i], spheres.z[i]);
            objects_.push_back(std::make_unique<fcl::CollisionObjectd>(shape, pose));
            objects_.back()->setUserData(reinterpret_cast<void*>(static_cast<uintptr_t>(i)));
            all.push_back(objects_.back().get());
        }
        manager_->registerObjects(all);
        manager_->setup();
    }

    void query(const PosedLeaves& leaves, float reach, std::vector<uint32_t>& found) override {
        found.clear();
        found_.begin(spheres_->size());
        for (size_t l = 0; !objects_.empty() && l < leaves.x.size(); ++l) {
            const float limit = reach + leaves.radius[l];
            fcl::Transform3d pose = fcl::Transform3d::Identity();
            pose.translation() = fcl::Vector3d(leaves.x[l], leaves.y[l], leaves.z[l]);
            fcl::CollisionObjectd leaf(std::make_shared<fcl::Sphered>(limit * 1.00001), pose);
            FclQuery query{spheres_, &found_, &found, &leaf, leaves.x[l], leaves.y[l], leaves.z[l], limit};
            manager_->collide(&leaf, &query, visit);
        }
    }

private:
    const RegionSpheres* spheres_ = nullptr;
    std::vector<std::unique_ptr<fcl::CollisionObjectd>> objects_;
    std::unique_ptr<fcl::DynamicAABBTreeCollisionManagerd> manager_;
    FoundSet found_;
};

} // namespace

std::unique_ptr<CollisionPeer> makeFclTree() {
    return std::make_unique<FclTree>();
}

} // namespace fathom::peers
