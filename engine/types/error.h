// SPDX-License-Identifier: Apache-2.0
// The exception types. Never thrown in a haptic step, which reports by return values.
#pragma once

#include "engine/types/printable.h"

#include <stdexcept>
#include <string>
#include <utility>

namespace fathom {

// Base class. The message is one line, whatever it quotes. exitCode() is the program's exit code if nothing
// catches it.
class Error : public std::runtime_error {
public:
    explicit Error(std::string what)
        : std::runtime_error(printable(std::move(what))) {}
    virtual int exitCode() const noexcept { return 1; }
};

// Unusable input of the user. The message names file or option, field, value, and what is allowed.
class BadInput : public Error {
public:
    BadInput(const std::string& file, const std::string& field, const std::string& value,
             const std::string& allowed)
        : Error(file + ": " + field + ": " + value + " (allowed: " + allowed + ")") {}
    // Wraps such a message from another process.
    explicit BadInput(std::string line)
        : Error(std::move(line)) {}
    int exitCode() const noexcept override { return 2; }
};

// A device stopped working; opening it again may help.
class DeviceFailed : public Error {
public:
    using Error::Error;
};

// GPU memory, or host memory for the GPU, is exhausted.
class OutOfMemory : public DeviceFailed {
public:
    using DeviceFailed::DeviceFailed;
};

// No device that could be used is installed. The user has to change that, as after BadInput.
class DeviceMissing : public DeviceFailed {
public:
    using DeviceFailed::DeviceFailed;
    int exitCode() const noexcept override { return 2; }
};

// A GPU, camera or haptic device is lost.
class DeviceLost : public DeviceFailed {
public:
    using DeviceFailed::DeviceFailed;
    int exitCode() const noexcept override { return 3; }
};

} // namespace fathom
