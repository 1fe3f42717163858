// SPDX-License-Identifier: Apache-2.0
// Poses from and to NumPy.
#include "apps/python/bind.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace py = pybind11;

namespace fathom::python {

namespace {

constexpr double kOrthonormal = 1e-4; // largest error of a rotation matrix; files have six digits or fewer

std::string shapeOf(const py::array& array) {
    std::ostringstream text;
    text << "(";
    for (py::ssize_t i = 0; i < array.ndim(); ++i) {
        text << (i > 0 ? ", " : "") << array.shape(i);
    }
    return text.str() + ")";
}

// Rows of a rotation matrix to a quaternion, by the largest of its components.
Quaternion quaternionOf(const double (&r)[3][3]) {
    const double trace = r[0][0] + r[1][1] + r[2][2];
    if (trace > 0.0) {
        const double s = 2.0 * std::sqrt(1.0 + trace);
        return {s / 4.0, (r[2][1] - r[1][2]) / s, (r[0][2] - r[2][0]) / s, (r[1][0] - r[0][1]) / s};
    }
    const int i = r[0][0] >= r[1][1] && r[0][0] >= r[2][2] ? 0 : r[1][1] >= r[2][2] ? 1 : 2;
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const double s = 2.0 * std::sqrt(1.0 + r[i][i] - r[j][j] - r[k][k]);
    double v[3];
    v[i] = s / 4.0;
    v[j] = (r[j][i] + r[i][j]) / s;
    v[k] = (r[k][i] + r[i][k]) / s;
    return {(r[k][j] - r[j][k]) / s, v[0], v[1], v[2]};
}

void checkRotation(const double (&r)[3][3]) {
    const double det = r[0][0] * (r[1][1] * r[2][2] - r[1][2] * r[2][1]) -
                       r[0][1] * (r[1][0] * r[2][2] - r[1][2] * r[2][0]) +
                       r[0][2] * (r[1][0] * r[2][1] - r[1][1] * r[2][0]);
    double most = 0.0;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            const double dot = r[i][0] * r[j][0] + r[i][1] * r[j][1] + r[i][2] * r[j][2];
            most = std::max(most, std::abs(dot - (i == j ? 1.0 : 0.0)));
        }
    }
    std::ostringstream text;
    text << "pose: the upper left 3 x 3 part ";
    if (!(most <= kOrthonormal)) {
        text << "times its transpose differs from the identity by " << most
             << " (allowed: a rotation matrix, within " << kOrthonormal << ")";
        throw py::value_error(text.str());
    }
    if (det < 0.0) {
        text << "has the determinant -1, a mirror image (allowed: a rotation matrix)";
        throw py::value_error(text.str());
    }
}

// Of a matrix that is not quite a rotation.
Quaternion unit(const Quaternion& q) {
    const double norm = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    return {q.w / norm, q.x / norm, q.y / norm, q.z / norm};
}

Pose poseOf(const py::array_t<double, py::array::c_style | py::array::forcecast>& matrix) {
    if (matrix.ndim() != 2 || matrix.shape(0) != 4 || matrix.shape(1) != 4) {
        throw py::value_error("pose: array of shape " + shapeOf(matrix) + " (allowed: (4, 4))");
    }
    const auto m = matrix.unchecked<2>();
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) {
            finite("pose", m(i, j));
        }
        if (m(3, i) != (i == 3 ? 1.0 : 0.0)) {
            throw py::value_error("pose: last row of the matrix (allowed: 0, 0, 0, 1)");
        }
    }
    double r[3][3];
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            r[i][j] = m(i, j);
        }
    }
    checkRotation(r);
    return {{m(0, 3), m(1, 3), m(2, 3)}, unit(quaternionOf(r))};
}

// Complex numbers would lose a part with no more than a warning.
Pose poseOfArray(const py::array& matrix) {
    checkNoMask("pose", matrix);
    if (matrix.dtype().kind() == 'c') {
        throw py::value_error("pose: complex numbers (allowed: real ones)");
    }
    return poseOf(matrix);
}

// An array where a pose is wanted. py::implicitly_convertible() would say "incompatible arguments" for a
// matrix that is not a pose, and lose the reason.
PyObject* poseFromArgument(PyObject* argument, PyTypeObject* pose) {
    if (!py::isinstance<py::array>(argument)) {
        return nullptr;
    }
    PyObject* made = PyObject_CallFunctionObjArgs(reinterpret_cast<PyObject*>(pose), argument, nullptr);
    if (made == nullptr) {
        throw py::error_already_set();
    }
    return made;
}

Pose poseFrom(const Vec3& position, const std::array<double, 4>& rotation) {
    for (const double value : position) {
        finite("position", value);
    }
    double largest = 0.0;
    for (const double value : rotation) {
        largest = std::max(largest, std::abs(finite("rotation", value)));
    }
    if (!(largest > 0.0)) {
        throw py::value_error("rotation: norm 0 (allowed: a quaternion w, x, y, z that is not zero)");
    }
    int exponent = 0;
    std::frexp(largest, &exponent);
    std::array<double, 4> q = rotation; // scaled, so that no square over- or underflows; exactly, by 2^n
    double squares = 0.0;
    for (double& value : q) {
        value = std::ldexp(value, -exponent);
        squares += value * value;
    }
    const double norm = std::sqrt(squares);
    return {position, {q[0] / norm, q[1] / norm, q[2] / norm, q[3] / norm}};
}

py::array_t<double> matrixOf(const Pose& pose) {
    const auto& [w, x, y, z] = pose.rotation;
    py::array_t<double> out({4, 4});
    auto m = out.mutable_unchecked<2>();
    const double rows[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                               {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                               {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            m(i, j) = rows[i][j];
        }
        m(i, 3) = pose.position[static_cast<size_t>(i)];
        m(3, i) = 0.0;
    }
    m(3, 3) = 1.0;
    return out;
}

} // namespace

py::array_t<double> array(const Vec3& v) {
    return py::array_t<double>(3, v.data());
}

double finite(const char* name, double value) {
    if (!std::isfinite(value)) {
        throw py::value_error(std::string(name) + ": " + std::to_string(value) +
                              " (allowed: finite numbers)");
    }
    return value;
}

void checkNoMask(const char* name, const py::array& array) {
    const py::module_ masked = py::module_::import("numpy.ma");
    if (py::isinstance(array, masked.attr("MaskedArray")) && masked.attr("is_masked")(array).cast<bool>()) {
        throw py::value_error(std::string(name) +
                              ": masked values (allowed: an array without a mask; use filled(0))");
    }
}

void bindTypes(py::module_& module) {
    py::class_<Pose>(module, "Pose",
                     "Rigid pose. A pose named a_T_b maps points from frame b to frame a.\n\n"
                     "Pose(position=(x, y, z), rotation=(w, x, y, z)) takes metres and a quaternion;\n"
                     "Pose(matrix) takes a homogeneous 4 x 4 matrix. Functions that want a pose take such a\n"
                     "matrix as well.")
        .def(py::init(&poseFrom), py::arg("position") = Vec3{},
             py::arg("rotation") = std::array<double, 4>{1, 0, 0, 0})
        .def(py::init(&poseOfArray), py::arg("matrix"))
        .def(py::init(&poseOf), py::arg("matrix"))
        .def_property_readonly(
            "position", [](const Pose& p) { return array(p.position); }, "[m], 3 values")
        .def_property_readonly(
            "rotation",
            [](const Pose& p) {
                return py::make_tuple(p.rotation.w, p.rotation.x, p.rotation.y, p.rotation.z);
            },
            "unit quaternion w, x, y, z")
        .def("matrix", &matrixOf, "As a homogeneous 4 x 4 matrix.")
        .def("__repr__", [](const Pose& p) {
            std::ostringstream text;
            text << "Pose(position=(" << p.position[0] << ", " << p.position[1] << ", " << p.position[2]
                 << "), rotation=(" << p.rotation.w << ", " << p.rotation.x << ", " << p.rotation.y << ", "
                 << p.rotation.z << "))";
            return text.str();
        });
    py::detail::get_type_info(typeid(Pose))->implicit_conversions.push_back(&poseFromArgument);
    module.def("now", &now, "The current time [ns] of CLOCK_MONOTONIC (time.monotonic_ns()).");
    module.attr("__version__") = version();
}

} // namespace fathom::python
