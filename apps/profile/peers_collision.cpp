// SPDX-License-Identifier: Apache-2.0
// Contact queries: Fathom's grid on the CPU, its tree on the GPU, and the trees of other libraries find the
// region spheres within reach of the tool, on the same spheres, leaves and poses.
#include "apps/profile/frame_sequence.h"
#include "apps/profile/peers/nearby_oracle.h"
#include "apps/profile/peers/peers.h"
#include "apps/profile/peers_rows.h"

#include "engine/cloud/tree_query.h"
#include "engine/contact/cull_cpu.h"

#include <unordered_map>

namespace fathom::profile {

namespace {

constexpr double kPeerReach = 0.01; // [m]
constexpr size_t kPoses = 8;        // a timed sample is one query per pose

// One set of spheres on the host and on the device.
struct Rig {
    FrameBench bench;
    double treeMs; // p50 device time of the passes that build spheres and tree

    Rig(const StudyContext& context, const FrameSequence& source)
        : bench(context.device, everyPointScene(), source.camera)
        , treeMs(treeTime(bench.measure(source.frames, context.settings.repeats()))) {}
    static double treeTime(const FrameCost& cost) {
        const auto spheres = cost.passes.find("spheres"), tree = cost.passes.find("tree");
        const double own = tree != cost.passes.end() ? tree->second.p50 : 0.0; // GPUs: within `spheres`
        return spheres != cost.passes.end() ? spheres->second.p50 + own : NAN;
    }
    const HostFixtures& host() const { return bench.set().host; }
};

// One tool at several poses, from first contact to 20 mm deep, with the exact answers.
struct Workload {
    Tool tool;
    std::vector<Pose> poses;
    std::vector<PosedLeaves> leaves;
    std::vector<std::vector<double>> gaps;
    double found = 0.0; // mean count

    Workload(const Rig& rig, const Pose& camera, uint32_t leafCount)
        : tool(ballTool(leafCount)) {
        const Pose touch = touchingPose(ballTool(256), rig.host(), camera);
        for (size_t i = 0; i < kPoses; ++i) {
            const double across = 0.04 * (static_cast<double>(i) - 3.5);
            const double deep = 0.02 * static_cast<double>(i * 3 % kPoses) / (kPoses - 1.0);
            Pose& pose = poses.emplace_back(touch);
            pose.position += camera.rotation * dvec3(across, -0.5 * across, deep);
            poseLeaves(tool, pose, rig.host().origin, leaves.emplace_back());
            gaps.push_back(peers::nearbyGaps(rig.host().spheres, leaves.back(), kPeerReach));
            for (const double gap : gaps.back()) {
                found += gap <= 0.0 ? 1.0 / kPoses : 0.0;
            }
        }
    }
};

// Times work(pose index) over all poses; a sample is the mean of all poses.
template <class Work>
void timePoses(const StudyContext& context, Work&& work, StudyRow& row) {
    row.cost = timeCpu(context.settings.repeats(), [&] {
        for (size_t i = 0; i < kPoses; ++i) {
            work(i);
        }
    });
    for (Spread* s : {&row.cost.submit, &row.cost.cpu}) {
        s->p50 /= kPoses;
        s->p90 /= kPoses;
        s->p99 /= kPoses;
    }
}

// Runs query(pose index, found) at every pose, counts differences from float64, then times it.
template <class Query>
void answerAndTime(const StudyContext& context, const Workload& work, Query&& query, StudyRow& row) {
    std::vector<uint32_t> found;
    row.error = row.more[kTies] = 0.0;
    for (size_t i = 0; i < kPoses; ++i) {
        query(i, found);
        const peers::Disagreement d = peers::disagreement(work.gaps[i], found);
        row.error += static_cast<double>(d.differ);
        row.more[kTies] += static_cast<double>(d.ties);
    }
    row.more[kFound] = work.found;
    timePoses(
        context, [&](size_t i) { query(i, found); }, row);
}

void requireRight(const StudyRow& row) {
    verify(row.error == 0.0, "peers", row.source + ", " + row.setting,
           digits(row.error) + " spheres differ from float64");
}

StudyRow ourGrid(const StudyContext& context, const Rig& rig, const Workload& work,
                 const std::string& source) {
    StudyRow row = peerRow(source, "Fathom CPU grid");
    RegionGrid grid;
    row.more[kBuild] =
        timeCpu(context.settings.repeats(), [&] { grid.build(rig.host().spheres); }).submit.p50;
    row.more[kThreads] = 1.0;
    row.isDefault = true;
    CullCpu cull;
    answerAndTime(
        context, work,
        [&](size_t i, std::vector<uint32_t>& found) {
            cull.cull(work.leaves[i], static_cast<float>(kPeerReach), grid, found);
        },
        row);
    requireRight(row);
    return row;
}

// Compares the spheres of a full answer within the reach that it certifies, because an overflow halves the
// reach.
peers::Disagreement wholeDisagreement(const Rig& rig, const PosedLeaves& leaves, const ContactSet& set) {
    const RegionSpheres& spheres = rig.host().spheres;
    std::unordered_map<uint32_t, uint32_t> indexOf; // from slot number
    for (uint32_t i = 0; i < spheres.size(); ++i) {
        indexOf.emplace(spheres.source[i], i);
    }
    std::vector<uint32_t> found;
    for (const uint32_t slot : set.source) {
        found.push_back(indexOf.at(slot));
    }
    return peers::disagreement(peers::nearbyGaps(spheres, leaves, set.reach), found);
}

// The full answer for a tick: the same set, sorted, with all pairs and a certified reach.
StudyRow ourWholeAnswer(const StudyContext& context, const Rig& rig, const Workload& work,
                        const std::string& source) {
    StudyRow row = peerRow(source, "Fathom CPU whole answer");
    row.more[kThreads] = 1.0;
    CullCpu cull;
    ContactSet set;
    peers::Disagreement all;
    for (size_t i = 0; i < kPoses; ++i) {
        cull.query(work.tool, work.poses[i], kPeerReach, rig.host(), rig.bench.set().grid.get(), set);
        const peers::Disagreement d = wholeDisagreement(rig, work.leaves[i], set);
        all.differ += d.differ;
        all.ties += d.ties;
    }
    row.error = static_cast<double>(all.differ);
    row.more[kTies] = static_cast<double>(all.ties);
    requireRight(row);
    timePoses(
        context,
        [&](size_t i) {
            cull.query(work.tool, work.poses[i], kPeerReach, rig.host(), rig.bench.set().grid.get(), set);
        },
        row);
    return row;
}

StudyRow ourTree(const StudyContext& context, const Rig& rig, const Workload& work,
                 const std::string& source) {
    StudyRow row = peerRow(source, "Fathom GPU tree");
    cloud::TreeQuery query(rig.bench.queryContext());
    query.setTool(work.tool);
    NearPairs near;
    DecideScratch scratch;
    ContactSet set;
    const std::vector<uint32_t>& sources = rig.host().spheres.source;
    std::vector<uint32_t> indexOf(2u * rig.host().camera.depth.pixels());
    for (uint32_t i = 0; i < sources.size(); ++i) {
        indexOf[sources[i]] = i;
    }
    row.more[kBuild] = rig.treeMs;
    row.more[kThreads] = deviceThreads(context.device);
    answerAndTime(
        context, work,
        [&](size_t i, std::vector<uint32_t>& found) {
            fillContactSet(work.tool, work.poses[i], kPeerReach, rig.host(), {}, set);
            verify(query.list(rig.bench.set(), work.poses[i], kPeerReach, near) &&
                       decidePairs(work.tool, near, SIZE_MAX, scratch, set),
                   "peers", row.setting, "overflow");
            found.clear();
            for (const uint32_t each : set.source) {
                found.push_back(indexOf[each]);
            }
        },
        row);
    requireRight(row);
    return row;
}

// A peer library with its tree over one set.
struct BuiltPeer {
    peers::PeerMethod<peers::CollisionPeer> method;
    std::unique_ptr<peers::CollisionPeer> peer;
    double buildMs;
};

std::vector<BuiltPeer> buildPeers(const StudyContext& context, const RegionSpheres& spheres) {
    const Repeats repeats = context.settings.quick ? Repeats{3, 10, 0.05} : Repeats{5, 50, 0.4};
    std::vector<BuiltPeer> built;
    for (auto& method : peers::collisionMethods()) {
        auto peer = method.make();
        const double ms = timeCpu(repeats, [&] { peer->build(spheres); }).submit.p50;
        built.push_back({std::move(method), std::move(peer), ms});
    }
    return built;
}

void addSource(const StudyContext& context, const FrameSequence& frames, const std::vector<uint32_t>& tools,
               std::vector<StudyRow>& rows) {
    const Rig rig(context, frames);
    if (rig.host().spheres.size() == 0) {
        return;
    }
    const auto built = buildPeers(context, rig.host().spheres);
    for (const uint32_t leaves : tools) {
        const Workload work(rig, frames.frames.front().baseTcamera, leaves);
        const std::string source = kContactPrefix +
                                   digits(static_cast<double>(rig.host().spheres.size()) / 1000.0, 4) +
                                   " k spheres x " + std::to_string(leaves) + " leaves";
        const size_t first = rows.size();
        rows.push_back(ourGrid(context, rig, work, source));
        rows.push_back(ourTree(context, rig, work, source));
        for (const BuiltPeer& b : built) {
            StudyRow row = peerRow(source, b.method.name);
            row.more[kBuild] = b.buildMs;
            row.more[kThreads] = b.method.threads;
            answerAndTime(
                context, work,
                [&](size_t i, std::vector<uint32_t>& found) {
                    b.peer->query(work.leaves[i], static_cast<float>(kPeerReach), found);
                },
                row);
            rows.push_back(std::move(row));
        }
        rows.push_back(ourWholeAnswer(context, rig, work, source));
        fillRatios(rows, first, first, first + 1);
    }
}

} // namespace

void addPeerCollision(const StudyContext& context, std::vector<StudyRow>& rows) {
    const bool quick = context.settings.quick;
    const std::vector<uint32_t> tools =
        quick ? std::vector<uint32_t>{1, 64} : std::vector<uint32_t>{1, 64, 1024};
    if (!context.settings.source.empty()) {
        addSource(context, recordedFrames(context.settings.source, 1), tools, rows);
        return;
    }
    using Sizes = std::vector<std::pair<uint32_t, uint32_t>>;
    for (const auto& [width, height] :
         quick ? Sizes{{40, 25}, {128, 80}} : Sizes{{40, 25}, {128, 80}, {400, 250}}) {
        addSource(context, wallFrame(width, height, 1.0), tools, rows);
    }
}

} // namespace fathom::profile
