// SPDX-License-Identifier: Apache-2.0
// What a free tool and an arm decide alike: names of rows, which leaves are behind a surface, what lines
// allow.
#pragma once

#include "engine/contact/contact_row.h"
#include "engine/contact/contact_set.h"
#include "engine/contact/leaf_centres.h"
#include "engine/contact/shapes.h"

#include <cstdint>
#include <span>

namespace fathom::proxy {

// Names a row that is of no sphere, the same from turn to turn. side: below 256; its low byte is read back.
uint64_t rowKey(ContactRow::Kind kind, uint32_t shape, uint32_t leaf, size_t side) noexcept;

// Leaves that the query found behind a surface and that have not been brought out since: exempt[leaf] = way
// to the camera, zero for all others; clearance[leaf] = [m] left along it, written where exempt is not zero.
// leaves: centres now, about the set's origin.
void flagBehind(const ContactSet& contacts, const LeafCentres& leaves, std::span<dvec3> exempt,
                std::span<double> clearance) noexcept;

// A line or axis lets the tool go from one pose to another: no farther off it in length or angle, or at rest
// on it.
bool equalityAllows(const Shape& shape, const Pose& from, const Pose& to) noexcept;

} // namespace fathom::proxy
