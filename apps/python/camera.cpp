// SPDX-License-Identifier: Apache-2.0
// Cameras: depth and colour images from NumPy arrays.
#include "apps/python/bind.h"

namespace py = pybind11;

namespace fathom::python {

namespace {

std::string text(const py::handle& object) {
    return py::str(object).cast<std::string>();
}

// Throws unless the array has this type and shape, without masked values, in rows without gaps and aligned.
void checkArray(const char* name, const py::array& array, const py::dtype& type,
                const std::vector<py::ssize_t>& shape, size_t alignment) {
    checkNoMask(name, array);
    const std::vector<py::ssize_t> is(array.shape(), array.shape() + array.ndim());
    if (!array.dtype().equal(type) || is != shape) {
        throw py::value_error(std::string(name) + ": " + text(array.dtype()) + " of shape " +
                              text(array.attr("shape")) + " (allowed: " + text(type) + " of shape " +
                              text(py::tuple(py::cast(shape))) + ")");
    }
    if ((array.flags() & py::array::c_style) == 0) {
        throw py::value_error(std::string(name) + ": strides " + text(array.attr("strides")) +
                              " (allowed: rows without gaps; use numpy.ascontiguousarray)");
    }
    if (reinterpret_cast<uintptr_t>(array.data()) % alignment != 0) {
        throw py::value_error(std::string(name) + ": address is not a multiple of " +
                              std::to_string(alignment) + " (use numpy.copy)");
    }
}

// Bytes per pixel.
py::ssize_t bytesOf(ColourFormat format) {
    return format == ColourFormat::Rgb ? 3 : format == ColourFormat::Rgba ? 4 : 2;
}

void check(const char* name, const Intrinsics& lens) {
    const std::string prefix = std::string(name) + ".";
    const std::pair<const char*, double> all[]{
        {"fx", lens.fx}, {"fy", lens.fy}, {"cx", lens.cx}, {"cy", lens.cy}};
    for (const auto& [field, value] : all) {
        finite((prefix + field).c_str(), value);
    }
    for (const double value : lens.distortion) {
        finite((prefix + "distortion").c_str(), value);
    }
}

CameraModel modelOf(const Intrinsics& depth, DepthFormat depthFormat, double metresPerUnit,
                    ColourFormat colourFormat, const std::optional<Intrinsics>& colour,
                    const Pose& colourTdepth, const std::string& name) {
    check("depth", depth);
    if (colour) {
        check("colour", *colour);
    }
    return {name,         depth,  depthFormat, finite("metres_per_unit", metresPerUnit),
            colourFormat, colour, colourTdepth};
}

SubmitStatus submit(CameraInput& camera, const py::array& depth, const py::object& colour,
                    const Pose& baseTcamera, std::optional<Nanoseconds> stamp) {
    const Images both = images(camera.model, depth, colour);
    return camera.port.submit({both.depth, both.colour, baseTcamera, stamp.value_or(now())});
}

void bindFormats(py::module_& module) {
    py::enum_<DepthFormat>(module, "DepthFormat", "Values of depth images.")
        .value("UINT16", DepthFormat::Uint16, "uint16; times metres_per_unit is the distance; 0 = none")
        .value("METRES", DepthFormat::Metres,
               "float32 [m]; not positive, not finite, or beyond 6.5535 m and the scene's camera.far = none");
    py::enum_<ColourFormat>(module, "ColourFormat", "Bytes of colour images.")
        .value("NONE", ColourFormat::None)
        .value("RGB", ColourFormat::Rgb, "uint8, shape (height, width, 3)")
        .value("RGBA", ColourFormat::Rgba, "uint8, shape (height, width, 4); alpha is ignored")
        .value("YUYV", ColourFormat::Yuyv, "uint8, shape (height, width, 2)");
    py::enum_<SubmitStatus>(module, "SubmitStatus", "What became of a submitted frame.")
        .value("ACCEPTED", SubmitStatus::Accepted)
        .value("MISSING_STAMP", SubmitStatus::MissingStamp, "zero or negative")
        .value("STAMP_AHEAD", SubmitStatus::StampAhead, "more than 5 ms ahead of now()")
        .value("STAMP_BACK", SubmitStatus::StampBack, "not later than the one before")
        .value("MISSING_IMAGE", SubmitStatus::MissingImage)
        .value("BAD_POSE", SubmitStatus::BadPose)
        .value("CLOSED", SubmitStatus::Closed, "the engine is closed, or failed: Engine.failure says why");
}

} // namespace

Images images(const CameraModel& model, const py::array& depth, const py::object& colour) {
    const auto h = static_cast<py::ssize_t>(model.depth.height),
               w = static_cast<py::ssize_t>(model.depth.width);
    const bool metres = model.depthFormat == DepthFormat::Metres;
    checkArray("depth", depth, metres ? py::dtype::of<float>() : py::dtype::of<uint16_t>(), {h, w},
               metres ? alignof(float) : alignof(uint16_t));
    if (model.colourFormat == ColourFormat::None) {
        if (!colour.is_none()) {
            throw py::value_error(
                "colour: an image (allowed: None, because the camera's colour_format is NONE)");
        }
        return {depth.data(), nullptr};
    }
    if (!py::isinstance<py::array>(colour)) {
        throw py::value_error("colour: " + py::repr(colour.get_type()).cast<std::string>() +
                              " (allowed: an array of the camera's colour_format)");
    }
    const auto pixels = colour.cast<py::array>();
    const Intrinsics& lens = model.colour ? *model.colour : model.depth;
    checkArray("colour", pixels, py::dtype::of<uint8_t>(),
               {static_cast<py::ssize_t>(lens.height), static_cast<py::ssize_t>(lens.width),
                bytesOf(model.colourFormat)},
               model.colourFormat == ColourFormat::Rgb ? 1 : 4);
    return {depth.data(), pixels.data()};
}

namespace {

void bindLens(py::module_& module) {
    py::class_<Intrinsics>(module, "Intrinsics",
                           "Pinhole lens with Brown-Conrady distortion k1 k2 p1 p2 k3; all in pixels. Pixel\n"
                           "(0, 0) is the centre of the first pixel.")
        .def(py::init([](uint32_t width, uint32_t height, double fx, double fy, double cx, double cy,
                         const std::array<double, 5>& distortion) {
                 return Intrinsics{width, height, fx, fy, cx, cy, distortion};
             }),
             py::arg("width"), py::arg("height"), py::arg("fx"), py::arg("fy"), py::arg("cx"), py::arg("cy"),
             py::arg("distortion") = std::array<double, 5>{})
        .def_readonly("width", &Intrinsics::width)
        .def_readonly("height", &Intrinsics::height)
        .def_readonly("fx", &Intrinsics::fx)
        .def_readonly("fy", &Intrinsics::fy)
        .def_readonly("cx", &Intrinsics::cx)
        .def_readonly("cy", &Intrinsics::cy)
        .def_readonly("distortion", &Intrinsics::distortion);
}

} // namespace

void bindCamera(py::module_& module) {
    bindFormats(module);
    bindLens(module);
    py::class_<CameraModel>(module, "CameraModel",
                            "Lens and formats of one camera. Camera frames have z forward, x right, y down.\n"
                            "`colour` is the lens of a colour camera that is not registered to depth.")
        .def(py::init(&modelOf), py::arg("depth"), py::arg("depth_format") = DepthFormat::Uint16,
             py::arg("metres_per_unit") = 0.001, py::arg("colour_format") = ColourFormat::None,
             py::arg("colour") = py::none(), py::arg("colour_T_depth") = Pose{}, py::arg("name") = "camera")
        .def_readonly("depth", &CameraModel::depth)
        .def_readonly("colour", &CameraModel::colour)
        .def_readonly("name", &CameraModel::name);
    py::class_<CameraInput>(module, "CameraPort",
                            "Takes the frames of one camera: Engine.camera(). One thread.")
        .def("submit", &submit, py::arg("depth"), py::arg("colour") = py::none(), py::kw_only(),
             py::arg("base_T_camera") = Pose{}, py::arg("stamp") = py::none(),
             "Copies the frame and returns a SubmitStatus. The newest frame wins.\n\n"
             "depth: array of shape (height, width), uint16 or float32 by the camera's depth_format.\n"
             "colour: array of uint8 of the camera's colour_format, or None.\n"
             "base_T_camera: pose of the depth camera when the frame was taken.\n"
             "stamp: when it was taken, [ns] as fathom.now(); None = now.\n\n"
             "Raises ValueError that names the argument if an array does not fit.")
        .def(
            "clock_jumped", [](CameraInput& camera) { camera.port.clockJumped(); },
            "The next stamp may be earlier than the last one, for example after your conversion to\n"
            "CLOCK_MONOTONIC was corrected.")
        .def_property_readonly(
            "dropped", [](const CameraInput& camera) { return camera.port.dropped(); },
            "frames that a newer one replaced")
        .def_property_readonly(
            "processed", [](const CameraInput& camera) { return camera.port.processed(); },
            "frames that became a fixture set");
}

} // namespace fathom::python
