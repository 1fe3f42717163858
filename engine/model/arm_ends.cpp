// SPDX-License-Identifier: Apache-2.0
#include "engine/model/arm_ends.h"

#include "engine/model/bare_frames.h"
#include "engine/model/gripper_joints.h"
#include "engine/model/jaw_joint.h"
#include "engine/model/link_names.h"
#include "engine/types/error.h"
#include "engine/types/joined.h"

#include <algorithm>
#include <iterator>

namespace fathom {

namespace {

using LinkPtr = std::shared_ptr<const urdf::Link>;

constexpr size_t kMaxNamed = 6; // names in a note
constexpr int kMaxBehind = 2;   // joints of an unknown gripper behind a tool frame

class EndChooser {
public:
    EndChooser(const urdf::ModelInterface& model, const std::filesystem::path& file)
        : model_(model)
        , file_(file)
        , grippers_(model, file) {}

    LinkPtr named(const std::string& name) const {
        LinkPtr link = model_.getLink(name);
        if (!link) {
            const std::string names = joined(model_.links_, [](const auto& other) { return other.first; });
            throw BadInput(file_.string(), "link", "'" + excerpt(name) + "'", excerpt(names, 1000));
        }
        return link;
    }

    void chooseTip(ArmEnds& ends) {
        walk({ends.base, 0});
        any_ = std::any_of(seen_.begin(), seen_.end(),
                           [](const Seen& s) { return s.moving > 0 && !s.inGripper; });
        for (const Seen& s : seen_) {
            most_ = usable(s) ? std::max(most_, s.moving) : most_;
        }
        const Seen* best = nullptr;
        for (const Seen& s : seen_) {
            if (isTool(s) && (best == nullptr || s.moving > best->moving ||
                              (s.moving == best->moving && betters(s, *best)))) {
                best = &s;
            }
        }
        ends.tipWhy = "a tool frame by its name";
        if (best == nullptr) {
            best = &*std::find_if(seen_.begin(), seen_.end(),
                                  [&](const Seen& s) { return usable(s) && s.moving == most_; });
            ends.tipWhy = best->gripperBelow ? "the end of the longest chain before a gripper"
                                             : "the end of the longest chain";
        }
        noteShorter(ends, *best);
        noteOthers(ends, *best);
        noteSkipped(ends, *best);
        if (const std::string joints = behind(*best); !joints.empty()) {
            ends.notes.push_back("joints that move lie behind the tip " + best->link->name +
                                 " and stay where they are: " + joints + "; arm.tip selects another");
        }
        if (best->rank == kNoTool && best->moving > 2 && !turnsHand(wordsOf(model_, *best->last))) {
            if (const std::string warning = jawWarning(*best->last, gripperHolder(*best)); !warning.empty()) {
                ends.notes.push_back(warning);
            }
        }
        ends.tip = best->rank < kNoTool ? best->link : endOf(*best);
        if (best->rank == kNoTool && ends.tip != bodyAt(model_, best->link)) {
            ends.tipWhy = "the frame fixed to the end of the longest chain";
        }
        noteFrames(ends);
    }

private:
    struct Seen { // a link below the base
        LinkPtr link;
        int moving;                         // joints between the base and it
        const urdf::Joint* last = nullptr;  // last moving joint above it
        bool inGripper = false;             // carried by a gripper joint
        bool gripperBelow = false;          // the next joint that moves closes a gripper
        bool inHand = false;                // behind fixed joints of a link that branches into fingers
        const urdf::Joint* named = nullptr; // the gripper joint, if only its names say so
        int before = 0;                     // joints between the base and the gripper
        size_t rank = kNoTool;
    };

    bool usable(const Seen& s) const { return !any_ || !s.inGripper; }

    // Whether the frame has a tool's name and is near the end of the longest chain.
    bool isTool(const Seen& s) const {
        const bool near = 2 * s.moving > most_ && most_ - s.moving <= kMaxBehind;
        return usable(s) && s.moving > 0 && near && s.rank < kNoTool &&
               !(namesPart(s.link->name) && !behind(s).empty());
    }

    // Of two tool frames behind as many joints.
    static bool betters(const Seen& frame, const Seen& than) {
        return frame.rank < than.rank || isBehind(frame, than);
    }

    // The tip of an arm that ends there.
    LinkPtr endOf(const Seen& s) const {
        return isTool(s) ? s.link : bareEnd(model_, grippers_, bodyAt(model_, s.link));
    }

    // The joints from a frame to the end of a longer chain, if it ends in no gripper: one joint behind the
    // other, and at least one of them as those of an arm. Empty = none.
    std::string behind(const Seen& frame) const {
        for (auto end = seen_.rbegin(); end != seen_.rend(); ++end) {
            std::string names;
            bool arm = false, row = end->moving > frame.moving && usable(*end);
            LinkPtr link = end->link;
            for (; row && link->parent_joint && link->parent_joint.get() != frame.last;
                 link = link->getParent()) {
                const urdf::Joint& joint = *link->parent_joint;
                if (moves(joint)) {
                    names = joint.name + (names.empty() ? "" : ", " + names);
                    arm = arm || movesAsArm(joint, wordsOf(model_, joint),
                                            grippers_.depthBelow(joint.child_link_name));
                    row = grippers_.branches(*model_.getLink(joint.parent_link_name)) == 1;
                }
            }
            if (row && arm && link->parent_joint) {
                return names;
            }
        }
        return "";
    }

    // A frame without shapes whose name is as good as that of a part: the tool centre of this gripper. It may
    // have a mass for simulators.
    static bool isBehind(const Seen& frame, const Seen& part) {
        const auto isPart = [](const urdf::Link& link) {
            return !link.collision_array.empty() || !link.visual_array.empty();
        };
        return frame.rank == part.rank && frame.last == part.last && !isPart(*frame.link) &&
               isPart(*part.link);
    }

    void walk(Seen seen) {
        const size_t at = seen_.size();
        seen.rank = toolRank(seen.link->name);
        seen_.push_back(seen);
        const bool fingers = seen.inHand || grippers_.branchesIntoFingers(*seen.link, seen.moving);
        for (const auto& joint : seen.link->child_joints) {
            if (isFree(*joint) && seen.moving > 0 && grippers_.depthThrough(*joint) == 0) {
                continue; // it would end the chain
            }
            Seen next = seen;
            next.link = model_.getLink(joint->child_link_name);
            const bool fixed = joint->type == urdf::Joint::FIXED;
            next.inHand = fingers && fixed;
            if (moves(*joint)) {
                const bool closes = fingers || grippers_.closes(*joint, seen.moving, seen.last);
                const bool grips = closes || grippers_.closesByName(*joint);
                seen_[at].gripperBelow = seen_[at].gripperBelow || grips;
                if (grips && !seen.inGripper) {
                    next.inGripper = true;
                    next.named = closes ? nullptr : joint.get();
                    next.before = seen.moving;
                }
                next.moving = seen.moving + 1;
                next.last = joint.get();
            }
            const size_t below = seen_.size();
            walk(next);
            seen_[at].gripperBelow = seen_[at].gripperBelow || (fixed && seen_[below].gripperBelow);
        }
    }

    // The link that would carry the gripper, if the last joints of the chain belong to one: the highest link
    // that branches below the last joint that moves as an arm's. Else the link above the last joint.
    std::string gripperHolder(const Seen& end) const {
        std::string holder = end.last->parent_link_name;
        int above = end.moving; // joints between the base and the link
        for (const urdf::Joint* joint = end.last; joint != nullptr;) {
            if (moves(*joint) &&
                movesAsArm(*joint, wordsOf(model_, *joint), grippers_.depthBelow(joint->child_link_name))) {
                break;
            }
            const LinkPtr link = model_.getLink(joint->parent_link_name);
            above -= moves(*joint);
            const bool hand =
                grippers_.branches(*link) > 1 && above >= std::max(2, grippers_.depthBelow(link->name));
            holder = hand ? link->name : holder;
            joint = link->parent_joint.get();
        }
        return holder;
    }

    // Names the longest chain elsewhere that has as many joints but seems to end before, by a gripper's name.
    void noteSkipped(ArmEnds& ends, const Seen& best) const {
        const Seen* longest = nullptr;
        for (const Seen& s : seen_) {
            const bool several = s.moving > s.before + 1; // one joint is rather a jaw beside the chain
            const bool leftOut =
                s.named != nullptr && several && s.before < best.moving && s.moving >= best.moving;
            longest = leftOut && (longest == nullptr || s.moving > longest->moving) ? &s : longest;
        }
        if (longest != nullptr && !best.inGripper) {
            ends.notes.push_back("a chain of " + std::to_string(longest->moving) + " joints to " +
                                 longest->link->name + " is left out: joint " + longest->named->name +
                                 " seems to be a gripper's by its names; arm.tip selects another");
        }
    }

    // Frames of a tool's name on shorter branches: the longest chain may be a hose.
    void noteShorter(ArmEnds& ends, const Seen& best) const {
        std::vector<std::string> names;
        for (const Seen& s : seen_) {
            const bool shorter = s.moving > 0 && s.moving < best.moving;
            if (usable(s) && shorter && namesTool(s.link->name) && !isAbove(*s.link, best.link)) {
                names.push_back(s.link->name);
            }
        }
        if (!names.empty() && best.rank == kNoTool) {
            ends.notes.push_back("tip " + best.link->name + " has more joints than " + firstOf(names) +
                                 " on other branches; arm.tip selects another");
        }
    }

    // Other ends with as many joints, on other branches: of each the tip that it would have as the arm.
    void noteOthers(ArmEnds& ends, const Seen& best) const {
        std::vector<const Seen*> others;
        for (const Seen& s : seen_) {
            if (s.moving == 0 || s.moving != best.moving || s.last == best.last || !usable(s)) {
                continue;
            }
            const auto same = std::ranges::find(others, s.last, &Seen::last);
            if (same == others.end()) {
                others.push_back(&s);
            } else if (isTool(s) && (!isTool(**same) || betters(s, **same))) {
                *same = &s;
            }
        }
        if (others.empty()) {
            return;
        }
        std::vector<std::string> names;
        std::ranges::transform(others, std::back_inserter(names),
                               [&](const Seen* s) { return endOf(*s)->name; });
        ends.notes.push_back("tip " + best.link->name + " is one of several ends of chains with " +
                             std::to_string(best.moving) +
                             " joints; arm.tip selects another: " + firstOf(names));
    }

    // Frames farther on: one may be meant as the tool's.
    void noteFrames(ArmEnds& ends) const {
        const std::vector<std::string> frames = framesBelow(model_, ends.tip);
        if (!frames.empty()) {
            ends.notes.push_back("frames without shapes are fixed to the tip " + ends.tip->name +
                                 "; arm.tip selects one: " + firstOf(frames));
        }
    }

    static std::string firstOf(std::vector<std::string> names) {
        const size_t more = names.size() - std::min(names.size(), kMaxNamed);
        names.resize(names.size() - more);
        return joined(names) + (more > 0 ? " and " + std::to_string(more) + " more" : "");
    }

    const urdf::ModelInterface& model_;
    const std::filesystem::path& file_;
    GripperJoints grippers_;
    std::vector<Seen> seen_;
    bool any_ = false; // a link outside of grippers moves
    int most_ = 0;     // joints of the longest chain
};

} // namespace

ArmEnds chooseEnds(const urdf::ModelInterface& model, const std::filesystem::path& file,
                   const std::string& base, const std::string& tip) {
    EndChooser chooser(model, file);
    ArmEnds ends;
    ends.base = base.empty() ? model.getRoot() : chooser.named(base);
    ends.baseWhy = base.empty() ? "the root" : "named by the scene";
    if (tip.empty()) {
        chooser.chooseTip(ends);
    } else {
        ends.tip = chooser.named(tip);
        ends.tipWhy = "named by the scene";
    }
    if (base.empty()) {
        lowerBase(model, ends);
    } else if (standsApart(*ends.base)) {
        ends.notes.push_back("base_T_arm is the pose of " + ends.base->name + ", not of the root " +
                             model.getRoot()->name + " above it");
    }
    return ends;
}

} // namespace fathom
