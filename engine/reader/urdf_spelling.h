// SPDX-License-Identifier: Apache-2.0
// Finds what urdfdom skips in a URDF without an error: elements and attributes that are misspelt, in the
// wrong place or given twice.
#pragma once

#include <string>
#include <vector>

namespace fathom {

// Throws BadInput that names the joint or link, the element and what is read instead. Extensions of other
// programs, which resemble nothing that is read, are allowed. file: for messages. notes: gets a line for each
// turn that may be in degrees, and for each limit that is missing while the other one is there.
void checkSpelling(const std::string& text, const std::string& file, std::vector<std::string>& notes);

} // namespace fathom
