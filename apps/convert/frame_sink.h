// SPDX-License-Identifier: Apache-2.0
// Where converted frames go.
#pragma once

#include "engine/types/frame.h"

namespace fathom {

class FrameSink {
public:
    virtual ~FrameSink() = default;
    // Throws Error when it cannot be written.
    virtual void add(const Frame& frame) = 0;
    virtual void finish() = 0;
};

} // namespace fathom
