// SPDX-License-Identifier: Apache-2.0
// Long calls run without the interpreter's lock, so that other Python threads continue.
#pragma once

#include <pybind11/pybind11.h>

namespace fathom::python {

// Releases the interpreter's lock during its lifetime, like pybind11::gil_scoped_release. A thread that would
// return to an interpreter that ends waits for the process's end instead: Python would end it amid C++
// frames, which ends the process with an abort.
class Unlocked {
public:
    Unlocked() noexcept;
    ~Unlocked();
    Unlocked(const Unlocked&) = delete;
    Unlocked& operator=(const Unlocked&) = delete;

private:
    PyThreadState* state_;
};

// False in a forked child without calls of its own: it has none of the threads whose calls count, and what
// they had locked stays locked.
bool usedInThisProcess() noexcept;

// The interpreter ends: only the calling thread returns to it from now on. Waits until the calls of others
// have ended, at most 10 s. Called once, by atexit.
void endInterpreter() noexcept;

} // namespace fathom::python
