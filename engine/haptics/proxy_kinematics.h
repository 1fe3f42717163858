// SPDX-License-Identifier: Apache-2.0
// What ConstrainedProxy asks of the kinematics of a free tool or of an arm. There are no virtual calls.
#pragma once

#include "engine/contact/contact_row.h"
#include "engine/contact/narrow_phase.h"
#include "engine/contact/shapes.h"
#include "engine/haptics/leaf_contacts.h"
#include "engine/haptics/proxy_rows.h"
#include "engine/haptics/proxy_step.h"

#include <concepts>
#include <cstddef>
#include <span>

namespace fathom {

// How a linearisation ended.
enum class StepOutcome {
    None, // no step was taken
    Last, // taken, but too short to be worth another solve
    More, // taken; another solve may get nearer to the target
};

// Where the leaves are, and the pose of the tool or of the arm's tip, in base axes.
template <class K>
concept KinematicsPlaces = requires(K& k, const K& now, LeafState& leaves, size_t leaf, const dvec3& centre) {
    // Number of the solver's unknowns.
    { now.unknowns() } -> std::same_as<size_t>;
    // base_T_tool or base_T_tip now, and after the motion that was tried last.
    { now.pose() } -> std::convertible_to<Pose>;
    { now.nextPose() } -> std::convertible_to<Pose>;
    // Origin of the leaf centres while there is no active set.
    { now.origin() } -> std::convertible_to<dvec3>;
    // Fills leaves.now about leaves.origin.
    { now.place(leaves) } -> std::same_as<void>;
    // A sphere around all leaves; its radius may be infinite.
    { now.bound() } -> std::same_as<Sphere>;
    // Centre of a leaf now, and after the motion that was tried last.
    { now.leafNow(leaf, leaves) } -> std::same_as<dvec3>;
    { now.leafNext(leaf, leaves) } -> std::same_as<dvec3>;
    // From the pose's position to the leaf, whose centre is given.
    { now.lever(leaf, centre) } -> std::same_as<dvec3>;
    // Makes the motion that was tried last the present state.
    { k.commit() } -> std::same_as<void>;
};

// The rows, in the solver's unknowns.
template <class K>
concept KinematicsRows = requires(const K& k, ProxyRows& rows, const ContactRow& row, const LeafState& leaves,
                                  const Equality& equality, double depth) {
    // Adds the limits of joints.
    { k.addLimits(rows) } -> std::same_as<void>;
    // Adds a row in the solver's unknowns. False: there is no room.
    { k.addRow(row, leaves, rows) } -> std::same_as<bool>;
    // [m] motion that a row of this depth requests, with the skin, within what is left for escapes.
    { k.escapeOffset(depth) } -> std::same_as<double>;
    // [m] or [rad] that an equation may correct in one solve.
    { k.equalityLimit(equality) } -> std::same_as<double>;
};

// One linearisation: begin, solve, cut and try until the exact check passes, then take or leave the step.
template <class K>
concept KinematicsStep = requires(K& k, typename K::Answer& answer, typename K::Step& out, LeafState& leaves,
                                  LeafContacts& contacts, ProxyRows& rows, const ProxyInput& input,
                                  double fraction, bool again, bool blocked) {
    // The target and the budgets of a tick.
    { k.begin(input, rows) } -> std::same_as<void>;
    // Linearises at the present state. False: nothing is left to do in this tick.
    { k.beginLinearisation(rows, out) } -> std::same_as<bool>;
    // Solves. again: with tightened rows. False: no motion obeys the rows, and `answer` is as before.
    { k.solve(answer, again, rows, out) } -> std::same_as<bool>;
    // Cuts the answer to the caps and tries it. True: the trust region is known to hold. False: the caller
    // must check it.
    { k.cutAndTry(answer, contacts, rows) } -> std::same_as<bool>;
    // Tries a fraction of the answer: fills leaves.next and nextPose(), at most fullFraction().
    { k.tryFraction(answer, fraction, leaves) } -> std::same_as<void>;
    // The fraction that cutAndTry() tried.
    { k.fullFraction(answer) } -> std::same_as<double>;
    // Fills out.allowed, cut and rowsExpired, before outcomeOf(). blocked: by the exact check.
    { k.recordAllowed(answer, blocked, contacts, rows, out) } -> std::same_as<void>;
    // Decides whether the tried motion is taken, and if so books it on the budgets of the tick.
    { k.outcomeOf(answer, fraction, leaves, rows, out) } -> std::same_as<StepOutcome>;
    // Completes the result of a tick.
    { k.report(out) } -> std::same_as<void>;
};

// Tightening of rows that the exact check found violated.
template <class K>
concept KinematicsTightening = requires(const K& k, const typename K::Answer& answer, ProxyRows& rows,
                                        const ContactRow& row, const LeafState& leaves,
                                        const NarrowPhase::Violation& violation,
                                        std::span<const Shape> shapes, double offset, double amount,
                                        double tried) {
    // The part of every row's offset that the tried motion reaches.
    { k.triedFraction(answer) } -> std::same_as<double>;
    // [m] by which the tried motion falls short of a violated pair's row, which needs `amount`.
    { k.shortfall(violation, amount, leaves) } -> std::same_as<double>;
    // The offset, raised by an amount. Only the tried fraction of it is reached.
    { k.raised(offset, amount, tried) } -> std::same_as<double>;
    // [m] by which the arc of the tried motion falls short of its linearisation along a row.
    { k.arcOf(answer, row, leaves) } -> std::same_as<double>;
    // Corrects the rows of equations. True: some row changed.
    { k.tightenEqualities(shapes, tried, rows) } -> std::same_as<bool>;
};

// K::Answer: what the solver found and how much of it is taken; K::Step: the result of a tick.
template <class K>
concept ProxyKinematics = KinematicsPlaces<K> && KinematicsRows<K> && KinematicsStep<K> &&
    KinematicsTightening<K> && std::derived_from<typename K::Step, ProxyStep> &&
    requires(typename K::Answer& answer) {
    // The trust region cut the answer.
    { answer.stalled } -> std::same_as<bool&>;
    // After the last tightening: solve once more, and bisect that answer.
    { K::kSolvesLastRound } -> std::convertible_to<bool>;
    // A keep_in shape holds only the leaves that are inside when it is placed.
    { K::kHoldsOnlyInside } -> std::convertible_to<bool>;
};

} // namespace fathom
