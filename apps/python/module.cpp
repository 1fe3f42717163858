// SPDX-License-Identifier: Apache-2.0
// The extension module fathom._fathom. Package `fathom` (apps/python/fathom) re-exports its names.
#include "apps/python/bind.h"
#include "apps/python/unlocked.h"

#include <pybind11/functional.h>

namespace py = pybind11;

namespace {

// The callback of set_log(). Engine threads call it, so it takes the interpreter's lock.
class PythonLog {
public:
    explicit PythonLog(py::function receiver)
        : receiver_(std::move(receiver)) {}

    void operator()(fathom::LogLevel level, std::string_view line) const noexcept {
        static constexpr const char* kNames[]{"debug", "info", "warning", "error"};
        const py::gil_scoped_acquire lock;
        try {
            receiver_(kNames[static_cast<int>(level)], py::str(line.data(), line.size()));
        } catch (py::error_already_set& error) {
            error.discard_as_unraisable("fathom.set_log callback");
        }
    }

private:
    py::function receiver_;
};

void setLog(const py::object& receiver) {
    if (receiver.is_none()) {
        const fathom::python::Unlocked others;
        fathom::setLogCallback({});
        return;
    }
    if (PyCallable_Check(receiver.ptr()) == 0) {
        throw py::type_error("receiver: " + std::string(py::str(py::type::of(receiver).attr("__name__"))) +
                             " (allowed: a function of level and line, or None)");
    }
    // Never destroyed without the interpreter's lock: a replaced receiver is kept.
    const auto* log = new PythonLog(receiver.cast<py::function>());
    const fathom::python::Unlocked others;
    fathom::setLogCallback([log](fathom::LogLevel level, std::string_view line) { (*log)(level, line); });
}

} // namespace

PYBIND11_MODULE(_fathom, module) {
    using namespace fathom::python;
    // Derived classes last: the newest translator is asked first.
    auto& error = py::register_exception<fathom::Error>(module, "Error", PyExc_RuntimeError);
    auto& badInput = py::register_exception<fathom::BadInput>(
        module, "BadInput", py::make_tuple(error, py::handle(PyExc_ValueError)));
    auto& lost = py::register_exception<fathom::ComputeDeviceLost>(module, "ComputeDeviceLost", error);
    error.doc() = "Base class of the errors of this module. One line.";
    badInput.doc() = "Something that you passed is unusable; names the field, its value and what is allowed.";
    lost.doc() = "The compute device is missing, was lost or has no memory left.";
    bindTypes(module);
    bindScene(module);
    bindCamera(module);
    bindHand(module);
    bindArm(module);
    bindObserver(module);
    bindEngine(module);
    module.def(
        "set_log", &setLog, py::arg("receiver"),
        "Sets receiver(level, line) for log lines of all engines, called from their threads; level is\n"
        "'debug', 'info', 'warning' or 'error'. None: log lines are discarded, the default.");
    // Registered first, so called last of all: no thread of an engine enters an interpreter that ends.
    py::module_::import("atexit").attr("register")(py::cpp_function([] {
        if (usedInThisProcess()) {
            setLog(py::none());
            endInterpreter();
            closeEngines();
        }
    }));
}
