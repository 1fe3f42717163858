// SPDX-License-Identifier: Apache-2.0
// Bullet: the box tree of its broad phase (btDbvt) over the spheres, with one collideTV() per leaf and the
// exact test in the callback. The tree is as inserted or rebuilt top-down.
#include "apps/profile/peers/found_set.h"
#include "apps/profile/peers/peers.h"

#include <BulletCollision/BroadphaseCollision/btDbvt.h>

namespace fathom::peers {

namespace {

struct Visit : btDbvt::ICollide {
    const RegionSpheres* spheres = nullptr;
    FoundSet* set = nullptr;
    std::vector<uint32_t>* found = nullptr;
    float x = 0.0f, y = 0.0f, z = 0.0f, limit = 0.0f;

    void Process(const btDbvtNode* node) override {
        set->test(*spheres, static_cast<uint32_t>(node->dataAsInt), x, y, z, limit, *found);
    }
};

class BulletTree : public CollisionPeer {
public:
    explicit BulletTree(bool topDown)
        : topDown_(topDown) {}

    void build(const RegionSpheres& spheres) override {
        spheres_ = &spheres;
        tree_ = std::make_unique<btDbvt>();
        for (size_t i = 0; i < spheres.size(); ++i) {
            const btDbvtVolume box =
                btDbvtVolume::FromCR(btVector3(spheres.x[i], spheres.y[i], spheres.z[i]), spheres.radius[i]);
            tree_->insert(box, nullptr)->dataAsInt = static_cast<int>(i);
        }
        if (topDown_) {
            tree_->optimizeTopDown();
        }
    }

    void query(const PosedLeaves& leaves, float reach, std::vector<uint32_t>& found) override {
        found.clear();
        found_.begin(spheres_->size());
        Visit visit;
        visit.spheres = spheres_;
        visit.set = &found_;
        visit.found = &found;
        for (size_t l = 0; l < leaves.x.size(); ++l) {
            visit.x = leaves.x[l];
            visit.y = leaves.y[l];
            visit.z = leaves.z[l];
            visit.limit = reach + leaves.radius[l];
            const btDbvtVolume box =
                btDbvtVolume::FromCR(btVector3(visit.x, visit.y, visit.z), visit.limit * 1.00001f);
            tree_->collideTV(tree_->m_root, box, visit);
        }
    }

private:
    bool topDown_;
    const RegionSpheres* spheres_ = nullptr;
    std::unique_ptr<btDbvt> tree_;
    FoundSet found_;
};

} // namespace

std::unique_ptr<CollisionPeer> makeBulletTree(bool topDown) {
    return std::make_unique<BulletTree>(topDown);
}

} // namespace fathom::peers
