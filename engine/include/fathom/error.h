// SPDX-License-Identifier: Apache-2.0
/// @file
/// Exceptions. Calls that are `noexcept`, such as HandPort::step() and ArmPort::report(), never throw.
/// CameraPort::submit() and lend() return a status; only exhausted memory makes them throw std::bad_alloc.
/// All other calls throw as their comments say.
#pragma once

#include <fathom/export.h>

#include <stdexcept>

namespace fathom::v0 {

/// Base class. what() is one line without control characters.
class FATHOM_API Error : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
    ~Error() override;
};

/// Something that you passed is unusable: a scene file, a camera description, a device name. what() names the
/// field, its value and the allowed values.
class FATHOM_API BadInput : public Error {
public:
    using Error::Error;
    ~BadInput() override;
};

/// The compute device is missing, was lost or has no memory left.
class FATHOM_API ComputeDeviceLost : public Error {
public:
    using Error::Error;
    ~ComputeDeviceLost() override;
};

} // namespace fathom::v0
