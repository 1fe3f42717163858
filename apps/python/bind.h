// SPDX-License-Identifier: Apache-2.0
// Parts of the Python module `fathom`. Each function adds the classes of one public header to the module.
#pragma once

#include <fathom/fathom.h>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h> // all bindings need the same casters

#include <string>

namespace fathom::python {

void bindTypes(pybind11::module_& module);
void bindScene(pybind11::module_& module);
void bindCamera(pybind11::module_& module);
void bindHand(pybind11::module_& module);
void bindArm(pybind11::module_& module);
void bindObserver(pybind11::module_& module);
void bindEngine(pybind11::module_& module);

// Ends the threads of every engine that was not closed.
void closeEngines();

// A copy as a NumPy array of three float64.
pybind11::array_t<double> array(const Vec3& v);

// Throws ValueError "NAME: VALUE (allowed: ...)" for values that are not finite.
double finite(const char* name, double value);

// Throws ValueError for masked values of a numpy.ma array: nothing reads the mask, so masked depth would
// become points.
void checkNoMask(const char* name, const pybind11::array& array);

// The images of one call, checked against the camera's description. They point into the arrays.
struct Images {
    const void* depth = nullptr;
    const void* colour = nullptr;
};
// Throws ValueError that names the argument, what it is and what is allowed: type, shape, strides, alignment.
Images images(const CameraModel& model, const pybind11::array& depth, const pybind11::object& colour);

// A camera's port together with what its images must look like.
struct CameraInput {
    CameraPort port;
    CameraModel model;
};

} // namespace fathom::python
