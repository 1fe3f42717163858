// SPDX-License-Identifier: Apache-2.0
// Compares moments.comp with a float64 computation over the same points, per patch and class.
#include "apps/verify/read_back.h"
#include "engine/cloud/guidance_pose.h"
#include "engine/reference/moments.h"
#include "tests/support/cloud_rig.h"
#include "tests/support/sanitized.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

struct MomentsAgreement {
    uint32_t patches = 0, classes = 0, wrong = 0;
    double patchMean = 0.0, mean = 0.0;             // [m]
    double patchCovariance = 0.0, covariance = 0.0; // relative to the trace
};

double covarianceError(const cloud::Moments& here, const reference::PointMoments& there) {
    double worst = 0.0;
    for (size_t k = 0; k < 6; ++k) {
        worst = std::max(worst, std::abs(here.products[k] / here.count - there.covariance[k]));
    }
    return there.trace() > 0.0 ? worst / there.trace() : worst;
}

// Points of one class in one patch, or in the whole frame (patch < 0).
std::vector<dvec3> pointsIn(const CloudRig& rig, const std::vector<uint32_t>& masks,
                            const reference::PointImage& points, size_t c, int patch) {
    std::vector<dvec3> out;
    const int across = static_cast<int>(rig.cycle().layout().across);
    for (size_t i = 0; i < masks.size(); ++i) {
        const int u = static_cast<int>(i) % rig.width(), v = static_cast<int>(i) / rig.width();
        if ((masks[i] >> c & 1) != 0 && points.z[i] != 0.0 &&
            (patch < 0 || v / 16 * across + u / 16 == patch)) {
            out.push_back(points.at[i] - rig.origin());
        }
    }
    return out;
}

cloud::Moments momentsOf(const shared::PatchMoments& m) {
    return {m.anchor.w,
            dvec3(m.anchor) + dvec3(m.offset),
            {m.first.x, m.first.y, m.first.z, m.first.w, m.second.x, m.second.y}};
}

void comparePatches(const CloudRig& rig, size_t c, size_t k, MomentsAgreement& a) {
    const std::vector<uint32_t> masks = rig.masks(), listed = rig.listed();
    const reference::PointImage points = rig.points();
    const auto all = verify::readBack<shared::PatchMoments>(vulkan().device, rig.set().device.moments);
    std::vector<cloud::Moments> parts;
    for (uint32_t patch = 0; patch < rig.cycle().layout().patches(); ++patch) {
        if ((listed[patch] & shared::kPatchGuided) == 0) { // no pixel of a guidance class
            continue;
        }
        const cloud::Moments here = momentsOf(all[patch * shared::kMaxClasses + k]);
        parts.push_back(here);
        if (patch % 7 != 0) { // every seventh patch individually; the merged class includes all
            continue;
        }
        const reference::PointMoments there =
            reference::moments(pointsIn(rig, masks, points, c, static_cast<int>(patch)));
        a.wrong += here.count != there.count;
        if (there.count > 0.0) {
            ++a.patches;
            a.patchMean = std::max(a.patchMean, glm::distance(here.mean, there.mean));
            a.patchCovariance = std::max(a.patchCovariance, covarianceError(here, there));
        }
    }
    const cloud::Moments merged = cloud::mergeAll(parts);
    const reference::PointMoments whole = reference::moments(pointsIn(rig, masks, points, c, -1));
    const GuidancePose& pose = rig.host().guidance[k];
    a.wrong += merged.count != whole.count || pose.count != whole.count;
    if (whole.count > 0.0) {
        ++a.classes;
        a.mean = std::max({a.mean, glm::distance(merged.mean, whole.mean),
                           glm::distance(pose.position, whole.mean + rig.origin())});
        a.covariance = std::max(a.covariance, covarianceError(merged, whole));
    }
}

MomentsAgreement compareMoments(const CloudRig& rig) {
    const auto classes = reference::pointClasses(rig.scene());
    MomentsAgreement a;
    size_t k = 0;
    for (size_t c = 0; c < classes.size(); ++c) {
        if (classes[c]->role == Role::Guidance) {
            comparePatches(rig, c, k++, a);
        }
    }
    REQUIRE(rig.host().guidance.size() == k);
    return a;
}

void add(MomentsAgreement& all, const MomentsAgreement& a) {
    all.patches += a.patches, all.classes += a.classes, all.wrong += a.wrong;
    all.patchMean = std::max(all.patchMean, a.patchMean), all.mean = std::max(all.mean, a.mean);
    all.patchCovariance = std::max(all.patchCovariance, a.patchCovariance),
    all.covariance = std::max(all.covariance, a.covariance);
}

} // namespace

TEST_CASE("Counts are equal, means agree within 1 um and covariances within 1e-6 of their trace, for every "
          "size and set of classes") {
    MomentsAgreement all;
    for (const CloudCase& c : cloudCases()) {
        CAPTURE(c.name);
        CloudRig rig(c.scene, c.camera);
        rig.run(c.image);
        if (!rig.plan().moments) {
            continue;
        }
        const MomentsAgreement a = compareMoments(rig);
        CHECK(a.wrong == 0);
        CHECK(a.mean < 1e-6);
        CHECK(a.patchMean < 1e-6);
        CHECK(a.covariance < 1e-6);
        CHECK(a.patchCovariance < 1e-6);
        add(all, a);
    }
    CHECK(all.classes > (kSanitized ? 5 : 10));
    MESSAGE("moments: largest error of a class mean ", all.mean * 1e6, " um, of a covariance ",
            all.covariance, " of its trace over ", all.classes, " classes; of a patch ", all.patchMean * 1e6,
            " um and ", all.patchCovariance, " over ", all.patches);
}

TEST_CASE("A small far guidance class keeps its covariance") {
    const CameraInfo camera = pinholeCamera(160, 120, 0.0001);
    for (const int edge : {3, 8, 17, 40}) {
        CAPTURE(edge);
        Scene scene = plainScene();
        scene.farZ = 6.0;
        scene.fixtures = {guidanceClass("goal")};
        CloudRig rig(scene, camera);
        rig.run(drawnImage(camera, [&](int u, int v) {
            return u >= 79 && v >= 47 && u < 79 + edge && v < 47 + edge ? 2.0 + 0.001 * u + 0.0005 * v : 0.0;
        }));
        const MomentsAgreement a = compareMoments(rig);
        CHECK(a.wrong == 0);
        CHECK(a.classes == 1);
        CHECK(a.mean < 1e-6);
        CHECK(a.covariance < 1e-6);
        MESSAGE(edge, " pixels wide at 2 m: covariance within ", a.covariance, " of its trace");
    }
}

TEST_CASE("Guidance classes that share pixels with other classes each count their own") {
    const CameraInfo camera = pinholeCamera(90, 70);
    Scene scene = plainScene();
    for (int i = 0; i < 7; ++i) {
        scene.fixtures.push_back(guidanceClass("goal"));
        scene.fixtures.back().box = Box{{-0.02 * i, -1, 0}, {0.5, 1, 3}};
    }
    CloudRig rig(scene, camera);
    const FrameReport report = rig.run(stressImage(camera, 61));
    const MomentsAgreement a = compareMoments(rig);
    CHECK(a.classes == 7);
    CHECK(a.wrong == 0);
    CHECK(a.mean < 1e-6);
    CHECK(a.covariance < 1e-6);
    for (size_t i = 0; i + 1 < 7; ++i) {
        CHECK(report.counts.classPixels[i + 2] > report.counts.classPixels[i + 1]);
    }
}
