// SPDX-License-Identifier: Apache-2.0
// Regions as arrays. The arrays are views of the object's memory and keep it alive.
#include "apps/python/bind.h"
#include "apps/python/unlocked.h"

namespace py = pybind11;

namespace fathom::python {

namespace {

// Column `member` of all spheres, without a copy; read-only.
template <typename T>
py::array view(const py::object& self, T* first, std::vector<py::ssize_t> shape) {
    std::vector<py::ssize_t> strides{sizeof(RegionSphere)};
    if (shape.size() > 1) {
        strides.push_back(sizeof(T));
    }
    py::array_t<T> out(std::move(shape), std::move(strides), first, self);
    out.attr("flags").attr("writeable") = false;
    return out;
}

const RegionSphere& first(const Regions& regions) {
    static const RegionSphere kNone;
    return regions.spheres.empty() ? kNone : regions.spheres.front();
}

py::ssize_t count(const Regions& regions) {
    return static_cast<py::ssize_t>(regions.spheres.size());
}

void bindRegions(py::module_& module) {
    py::class_<GuidanceTarget>(module, "GuidanceTarget", "A guidance target as one frame shows it.")
        .def_readonly("fixture", &GuidanceTarget::fixture, "index into the scene's fixtures")
        .def_readonly("present", &GuidanceTarget::present, "seen in this frame")
        .def_readonly("base_T_tool", &GuidanceTarget::baseTtool, "where the tool is pulled to, if present");
    py::class_<Regions>(module, "Regions",
                        "All regions of one frame. The union of the spheres is protected. The arrays are\n"
                        "read-only views that keep this object alive.")
        .def_readonly("frame", &Regions::frame, "number of the frame; -1 = none")
        .def_readonly("stamp", &Regions::stamp, "[ns] of the frame")
        .def_property_readonly(
            "origin", [](const Regions& r) { return array(r.origin); },
            "[m] base frame; centres are relative to it")
        .def_property_readonly(
            "centres",
            [](const py::object& self) {
                const auto& r = self.cast<const Regions&>();
                return view(self, first(r).centre.data(), {count(r), 3});
            },
            "[m] float32, shape (n, 3), base axes, relative to `origin`")
        .def_property_readonly(
            "radii",
            [](const py::object& self) {
                const auto& r = self.cast<const Regions&>();
                return view(self, &first(r).radius, {count(r)});
            },
            "[m] float32, shape (n,)")
        .def_property_readonly(
            "fixtures",
            [](const py::object& self) {
                const auto& r = self.cast<const Regions&>();
                return view(self, &first(r).fixture, {count(r)});
            },
            "uint32, shape (n,): index into the scene's fixtures")
        .def_readonly("targets", &Regions::targets, "list of GuidanceTarget")
        .def("__len__", [](const Regions& r) { return r.spheres.size(); });
}

} // namespace

void bindObserver(py::module_& module) {
    bindRegions(module);
    py::class_<ObserverPort>(module, "ObserverPort",
                             "Copies the newest results: Engine.open_observer(). One thread.")
        .def(
            "regions",
            [](ObserverPort& port) -> std::optional<Regions> {
                Regions out;
                const Unlocked others;
                return port.regions(out) ? std::optional(std::move(out)) : std::nullopt;
            },
            "The Regions of the newest frame, or None if there is no newer one than at the last call.")
        .def(
            "step",
            [](ObserverPort& port) -> std::optional<Step> {
                StepSnapshot out;
                return port.step(out) ? std::optional(out.step) : std::nullopt;
            },
            "The newest Step, or None if there is no newer one.");
}

} // namespace fathom::python
