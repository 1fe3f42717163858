// SPDX-License-Identifier: Apache-2.0
// The placed shapes, from any thread to the writer thread.
#pragma once

#include "engine/contact/shapes.h"

#include <mutex>
#include <span>
#include <vector>

namespace fathom {

// Any thread may call any function.
class ShapeBox {
public:
    void set(std::span<const Shape> shapes) {
        const std::lock_guard lock(mutex_);
        shapes_.assign(shapes.begin(), shapes.end());
        changed_ = true;
    }
    // True when set() was called after the last copyTo().
    bool changed() {
        const std::lock_guard lock(mutex_);
        return changed_;
    }
    void copyTo(std::vector<Shape>& out) {
        const std::lock_guard lock(mutex_);
        out = shapes_;
        changed_ = false;
    }

private:
    std::mutex mutex_;
    std::vector<Shape> shapes_;
    bool changed_ = false;
};

} // namespace fathom
