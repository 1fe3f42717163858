// SPDX-License-Identifier: Apache-2.0
// Embree: the centres as user geometry with one point query per leaf. Uses the Morton build
// (RTC_BUILD_QUALITY_LOW), which is meant for scenes that are rebuilt every frame.
#include "apps/profile/peers/found_set.h"
#include "apps/profile/peers/peers.h"

#include "engine/types/error.h"

#include <embree3/rtcore.h>

namespace fathom::peers {

namespace {

struct EmbreeQuery {
    const RegionSpheres* spheres;
    FoundSet* set;
    std::vector<uint32_t>* found;
    float x, y, z, limit;
};

void boundsOf(const RTCBoundsFunctionArguments* args) {
    const auto& s = *static_cast<const RegionSpheres*>(args->geometryUserPtr);
    RTCBounds& b = *args->bounds_o;
    b.lower_x = b.upper_x = s.x[args->primID];
    b.lower_y = b.upper_y = s.y[args->primID];
    b.lower_z = b.upper_z = s.z[args->primID];
}

bool visit(RTCPointQueryFunctionArguments* args) {
    const auto& request = *static_cast<const EmbreeQuery*>(args->userPtr);
    request.set->test(*request.spheres, args->primID, request.x, request.y, request.z, request.limit,
                      *request.found);
    return false; // the query radius does not shrink
}

class EmbreePoints : public CollisionPeer {
public:
    explicit EmbreePoints(uint32_t threads)
        : device_(rtcNewDevice(std::string("threads=").append(std::to_string(threads)).c_str())) {
        if (device_ == nullptr) {
            throw Error("Embree gives no device");
        }
    }
    EmbreePoints(const EmbreePoints&) = delete;
    EmbreePoints& operator=(const EmbreePoints&) = delete;
    ~EmbreePoints() override {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }

    void build(const RegionSpheres& spheres) override {
        if (scene_ != nullptr) {
            rtcReleaseScene(scene_);
        }
        spheres_ = &spheres;
        radius_ = largestRadius(spheres);
        scene_ = rtcNewScene(device_);
        rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_LOW);
        const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
        rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_LOW);
        rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(spheres.size()));
        rtcSetGeometryUserData(geometry, const_cast<RegionSpheres*>(&spheres));
        rtcSetGeometryBoundsFunction(geometry, boundsOf, nullptr);
        rtcSetGeometryPointQueryFunction(geometry, visit);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_);
        if (rtcGetDeviceError(device_) != RTC_ERROR_NONE) {
            throw Error("Embree did not build");
        }
    }

    void query(const PosedLeaves& leaves, float reach, std::vector<uint32_t>& found) override {
        found.clear();
        found_.begin(spheres_->size());
        RTCPointQueryContext context;
        rtcInitPointQueryContext(&context);
        for (size_t l = 0; l < leaves.x.size(); ++l) {
            const float limit = reach + leaves.radius[l];
            EmbreeQuery request{spheres_, &found_, &found, leaves.x[l], leaves.y[l], leaves.z[l], limit};
            RTCPointQuery query{request.x, request.y, request.z, 0.0f, (limit + radius_) * 1.00001f};
            rtcPointQuery(scene_, &query, &context, nullptr, &request);
        }
    }

private:
    RTCDevice device_ = nullptr;
    RTCScene scene_ = nullptr;
    const RegionSpheres* spheres_ = nullptr;
    float radius_ = 0.0f;
    FoundSet found_;
};

} // namespace

std::unique_ptr<CollisionPeer> makeEmbreePoints(uint32_t threads) {
    return std::make_unique<EmbreePoints>(threads);
}

} // namespace fathom::peers
