// SPDX-License-Identifier: Apache-2.0
#include "engine/cycle/arm_setup.h"

#include "engine/cycle/arm_notes.h"
#include "engine/model/arm_mimic.h"
#include "engine/model/arm_warnings.h"
#include "engine/types/error.h"
#include "engine/types/joined.h"

#include <algorithm>
#include <sstream>

namespace fathom {

namespace {

class RigMaker {
public:
    RigMaker(const Scene& scene, const SceneArm& arm, const ReaderOptions& reader)
        : scene_(scene)
        , arm_(arm)
        , reader_(reader)
        , armSetup_(std::make_unique<ArmSetup>()) {}

    std::unique_ptr<ArmSetup> make(std::span<const Sphere> toolLeaves) {
        armSetup_->model = loadArm(arm_.urdf, modelOptions());
        checkMotion();
        addTool(toolLeaves);
        if (armSetup_->model.leaves.size() > kMaxLeaves) {
            refuse("leaves", std::to_string(armSetup_->model.leaves.size()) + " of all links",
                   "at most " + std::to_string(kMaxLeaves));
        }
        armSetup_->baseTarm = arm_.baseTarm;
        armSetup_->freeDirection = arm_.freeDirection;
        armSetup_->graspButton = arm_.grasp.fingers.empty() ? 0 : arm_.grasp.button;
        // Includes 3 sigma like regions, because the registration error also displaces the image of the arm.
        armSetup_->padding = arm_.selfFilter ? *arm_.selfFilter + 3.0 * scene_.registrationSigma : 0.0;
        armSetup_->proxy.stepCap = scene_.haptics.stepCap;
        armSetup_->proxy.solves = scene_.haptics.solves;
        armSetup_->proxy.period = 1.0 / scene_.haptics.rateHz;
        setGraspTime();
        applyJoints();
        checkFingers();
        checkReach();
        for (const std::string& line : shapeNotes(scene_, *armSetup_)) {
            note(line);
        }
        return std::move(armSetup_);
    }

private:
    [[noreturn]] void refuse(const std::string& field, const std::string& value,
                             const std::string& allowed) const {
        throw BadInput(scene_.file.string(), "arm." + field, value, allowed);
    }

    ArmOptions modelOptions() const {
        ArmOptions options;
        options.base = arm_.base;
        options.tip = arm_.tip;
        options.meshes = arm_.meshes;
        options.leavesPerShape = arm_.leaves;
        options.locked = arm_.locked;
        options.keepStray = arm_.keepStray;
        options.reader = reader_;
        for (const auto& finger : arm_.grasp.fingers) {
            options.fingers.push_back({finger.joint, finger.open, finger.closed});
        }
        return options;
    }

    void checkMotion() const {
        const auto& joints = armSetup_->model.joints;
        if (std::ranges::all_of(joints, [](const ArmJoint& joint) { return bool(joint.mimic); })) {
            refuse("tip", armSetup_->model.tipText,
                   "a link with a moving joint between it and arm.base, here " + armSetup_->model.baseText);
        }
    }

    void setGraspTime() {
        const GraspTime least = graspTimeOf(armSetup_->model);
        if (least.seconds > arm_.grasp.seconds * (1.0 + 1e-9)) {
            note("finger " + least.finger + ": " + least.speed + " of the file make the grasp take " +
                 text(least.seconds) + " s instead of " + text(arm_.grasp.seconds) + " s");
        }
        armSetup_->proxy.graspPerTick = armSetup_->proxy.period / std::max(arm_.grasp.seconds, least.seconds);
    }

    void addTool(std::span<const Sphere> toolLeaves) {
        ArmModel& model = armSetup_->model;
        for (const Sphere& s : toolLeaves) {
            model.leaves.push_back({{model.lastTtip.apply(s.centre), s.radius},
                                    static_cast<uint32_t>(model.count()),
                                    static_cast<uint32_t>(model.links.size())});
        }
        if (!toolLeaves.empty()) {
            model.links.push_back("tool");
        }
    }

    size_t indexOf(const std::string& field, const std::string& name) const {
        const std::vector<ArmJoint>& joints = armSetup_->model.joints;
        const auto found = std::ranges::find(joints, name, &ArmJoint::name);
        if (found == joints.end()) {
            refuse(field + ".name", "'" + name + "'", joined(joints, &ArmJoint::name));
        }
        return static_cast<size_t>(found - joints.begin());
    }

    static std::string text(double value) {
        std::ostringstream out;
        out << value;
        return out.str();
    }

    void applyJoints() {
        for (size_t k = 0; k < armSetup_->model.count(); ++k) {
            armSetup_->start[k] =
                std::clamp(0.0, armSetup_->model.joints[k].lower, armSetup_->model.joints[k].upper);
        }
        for (size_t i = 0; i < arm_.joints.size(); ++i) {
            const SceneArm::Joint& wanted = arm_.joints[i];
            const std::string field = "joints[" + std::to_string(i) + "]";
            const size_t k = indexOf(field, wanted.name);
            ArmJoint& joint = armSetup_->model.joints[k];
            const ArmJoint urdf = joint;
            override(wanted, joint);
            noteUnlikely(wanted, urdf, joint);
            const std::string range =
                "lower <= upper, here " + text(joint.lower) + " to " + text(joint.upper);
            if (joint.lower > joint.upper) {
                refuse(field, wanted.name, range);
            }
            if (joint.mimic && wanted.start) {
                refuse(field + ".start", text(*wanted.start),
                       "no start, because the joint follows " +
                           armSetup_->model.joints[joint.mimic->joint].name);
            }
            const double start = wanted.start.value_or(std::clamp(0.0, joint.lower, joint.upper));
            if (start < joint.lower || start > joint.upper) {
                refuse(field + ".start", text(start), text(joint.lower) + " to " + text(joint.upper));
            }
            armSetup_->start[k] = start;
        }
        narrow();
        noteSpeeds();
    }

    static void override(const SceneArm::Joint& wanted, ArmJoint& joint) {
        if (wanted.lower || wanted.upper) {
            joint.limitsFrom = "scene";
        }
        joint.lower = wanted.lower.value_or(joint.lower);
        joint.upper = wanted.upper.value_or(joint.upper);
        if (wanted.speed) {
            joint.speed = *wanted.speed;
            joint.speedFrom = "scene";
        }
    }

    void note(const std::string& line) {
        std::vector<std::string>& notes = armSetup_->model.notes;
        if (!line.empty() && std::ranges::find(notes, line) == notes.end()) {
            notes.push_back(line);
        }
    }

    // Asks whether the scene's numbers are in other units. urdf: the joint before they replaced its own.
    void noteUnlikely(const SceneArm::Joint& wanted, const ArmJoint& urdf, const ArmJoint& joint) {
        if (wanted.lower || wanted.upper) {
            note(limitWarning(joint.name, joint.slides, joint.lower, joint.upper, kLongSlide));
            if (joint.lower < urdf.lower || joint.upper > urdf.upper) {
                note("joint " + joint.name + ": the scene's limits " + text(joint.lower) + " to " +
                     text(joint.upper) + " are wider than the file's, " + text(urdf.lower) + " to " +
                     text(urdf.upper));
            }
        }
        note(wanted.speed ? speedWarning(joint.name, joint.slides, *wanted.speed) : "");
    }

    // The scene's limits of mimic joints bind the joints that they follow.
    void narrow() {
        ArmModel& model = armSetup_->model;
        for (const std::string& line : narrowByMimics(model)) {
            note(line);
        }
        refuseNarrowed();
        for (size_t k = 0; k < model.count(); ++k) {
            armSetup_->start[k] =
                std::clamp(armSetup_->start[k], model.joints[k].lower, model.joints[k].upper);
        }
        model.follow(armSetup_->start);
    }

    // Limits are printed with six digits. What is printed is accepted: narrow() moves it to the exact limit.
    void refuseNarrowed() const {
        const auto rounded = [](double limit) { return 1e-5 * std::max(1.0, std::abs(limit)); };
        for (size_t i = 0; i < arm_.joints.size(); ++i) {
            const std::string field = "joints[" + std::to_string(i) + "]";
            const ArmJoint& joint = armSetup_->model.joints[indexOf(field, arm_.joints[i].name)];
            const double start = arm_.joints[i].start.value_or(joint.lower);
            if (start < joint.lower - rounded(joint.lower) || start > joint.upper + rounded(joint.upper)) {
                refuse(field + ".start", text(start),
                       text(joint.lower) + " to " + text(joint.upper) + ", the limits of " +
                           joint.limitsFrom);
            }
        }
    }

    void noteSpeeds() {
        std::string names;
        for (const ArmJoint& joint : armSetup_->model.joints) {
            if (joint.speedFrom == kDefaultSpeedSource && !joint.mimic) {
                names += (names.empty() ? "" : ", ") + joint.name;
            }
        }
        if (!names.empty()) {
            armSetup_->model.notes.push_back("no speed in the file for " + names + ": " + text(kUnknownTurn) +
                                             " rad/s or " + text(kUnknownSlide) +
                                             " m/s is used; arm.joints sets another");
        }
    }

    void checkFingers() const {
        for (size_t i = 0; i < arm_.grasp.fingers.size(); ++i) {
            const auto& wanted = arm_.grasp.fingers[i];
            const auto same = [&](const ArmFinger& finger) { return finger.name == wanted.joint; };
            const auto& fingers = armSetup_->model.fingers;
            const ArmFinger& finger = *std::ranges::find_if(fingers, same);
            for (const auto& [name, at] : {std::pair{"open", finger.open}, {"closed", finger.closed}}) {
                if (at < finger.lower || at > finger.upper) {
                    refuse("grasp.fingers[" + std::to_string(i) + "]." + name, text(at),
                           text(finger.lower) + " to " + text(finger.upper) + ", the joint's limits");
                }
            }
        }
    }

    // As Tool does for contact queries, which would name neither file nor link.
    void checkReach() const {
        const ArmModel& model = armSetup_->model;
        const ArmFrames frames = armSetup_->framesAt(armSetup_->startPosture());
        for (size_t i = 0; i < model.leaves.size(); ++i) {
            const dvec3 c = model.centre(frames, i), far = glm::abs(c);
            const double radius = model.leaves[i].sphere.radius;
            if (std::max({far.x, far.y, far.z}) <= kMaxToolReach && radius <= kMaxLeafRadius) {
                continue;
            }
            throw BadInput(arm_.urdf.string(), "link " + model.links[model.leaves[i].link],
                           "a sphere at (" + text(c.x) + ", " + text(c.y) + ", " + text(c.z) +
                               ") m, of radius " + text(radius) + " m",
                           "within " + text(kMaxToolReach) + " m of the base frame's origin, radius up to " +
                               text(kMaxLeafRadius) + " m; a URDF is in metres");
        }
    }

    const Scene& scene_;
    const SceneArm& arm_;
    const ReaderOptions& reader_;
    std::unique_ptr<ArmSetup> armSetup_;
};

} // namespace

std::unique_ptr<ArmSetup> makeArmSetup(const Scene& scene, std::span<const Sphere> toolLeaves,
                                       const ReaderOptions& reader) {
    return scene.arm ? RigMaker(scene, *scene.arm, reader).make(toolLeaves) : nullptr;
}

} // namespace fathom
