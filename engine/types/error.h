// SPDX-License-Identifier: Apache-2.0
// The family of exceptions. Thrown while things are built; never on the haptic tick, which returns values.
#pragma once

#include "engine/types/printable.h"

#include <stdexcept>
#include <string>
#include <utility>

namespace fathom {

// Root of the family, one line whatever it quotes. exitCode() is what the program ends with when nothing
// catches it.
class Error : public std::runtime_error {
public:
    explicit Error(std::string what)
        : std::runtime_error(printable(std::move(what))) {}
    virtual int exitCode() const noexcept { return 1; }
};

// Something the user gave is unusable: one line with the file (or option), the field, the value, what is
// allowed.
class BadInput : public Error {
public:
    BadInput(const std::string& file, const std::string& field, const std::string& value,
             const std::string& allowed)
        : Error(file + ": " + field + ": " + value + " (allowed: " + allowed + ")") {}
    // A line of that kind that another process has made.
    explicit BadInput(std::string line)
        : Error(std::move(line)) {}
    int exitCode() const noexcept override { return 2; }
};

// A device that worked does so no more; opened again it may.
class DeviceFailed : public Error {
public:
    using Error::Error;
};

// A GPU, or the host for it, has no memory left.
class OutOfMemory : public DeviceFailed {
public:
    using DeviceFailed::DeviceFailed;
};

// A GPU, camera or haptic device is gone.
class DeviceLost : public DeviceFailed {
public:
    using DeviceFailed::DeviceFailed;
    int exitCode() const noexcept override { return 3; }
};

} // namespace fathom
