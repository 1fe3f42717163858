// SPDX-License-Identifier: Apache-2.0
// The haptic device's port and the result of a step.
#include "apps/python/bind.h"

namespace py = pybind11;

namespace fathom::python {

namespace {

void bindFlags(py::module_& module) {
    const py::object flag = py::module_::import("enum").attr("IntFlag");
    using namespace pybind11::literals;
    module.attr("Button") =
        flag("Button",
             py::dict("GUIDANCE"_a = int(Button::Guidance), "DEAD_MAN_OPEN"_a = int(Button::DeadManOpen),
                      "CLUTCH"_a = int(Button::Clutch)),
             "module"_a = "fathom");
    using Warning = StepWarning;
    module.attr("StepWarning") =
        flag("StepWarning",
             py::dict("NO_SCENE"_a = int(Warning::NoScene), "OLD_SCENE"_a = int(Warning::OldScene),
                      "COMPUTE_DEVICE_LOST"_a = int(Warning::ComputeDeviceLost),
                      "NOT_FINITE"_a = int(Warning::NotFinite), "TIME_BACK"_a = int(Warning::TimeBack),
                      "STALLED"_a = int(Warning::Stalled), "ENGINE_FAILED"_a = int(Warning::EngineFailed),
                      "ARM_STILL"_a = int(Warning::ArmStill), "OTHER_CLOCK"_a = int(Warning::OtherClock)),
             "module"_a = "fathom");
    module.attr("Button").attr("__doc__") = "Buttons of the device that are down.";
    module.attr("StepWarning").attr("__doc__") = "What limits a step; see <fathom/hand.h>.";
    py::enum_<State>(module, "State", "What the forces do.")
        .value("OFF", State::Off, "no fixtures yet, or forces are off: the wrench is zero")
        .value("FREE", State::Free, "no fixture pushes")
        .value("CONTACT", State::Contact, "at least one fixture pushes")
        .value("ESCAPE", State::Escape, "new fixtures cover the tool; it moves out")
        .value("TRAPPED", State::Trapped, "no motion obeys every fixture: the force ramps out")
        .value("FADING", State::Fading, "the newest frame is too old, or forces were switched off")
        .value("WAITING", State::Waiting, "nothing pushes, and the tool lags behind the hand");
}

void bindContact(py::module_& module) {
    py::class_<Contact>(module, "Contact", "A contact that pushed. Base frame.")
        .def_property_readonly(
            "point", [](const Contact& c) { return array(c.point); }, "[m] on the tool")
        .def_property_readonly(
            "normal", [](const Contact& c) { return array(c.normal); }, "out of the fixture")
        .def_readonly("gap", &Contact::gap, "[m]")
        .def_readonly("fixture", &Contact::fixture,
                      "index into the scene's fixtures; 0xffffffff = the visible surface");
}

void bindWrench(py::class_<Step>& step) {
    step.def_property_readonly(
            "force", [](const Step& s) { return array(s.wrench.force); },
            "[N] on the hand, in the device's axes; zero on axes it does not drive")
        .def_property_readonly(
            "torque", [](const Step& s) { return array(s.wrench.torque); },
            "[N m] on the hand, in the device's axes, about the handle")
        .def_property_readonly(
            "residual_force", [](const Step& s) { return array(s.residual.force); },
            "[N] that the device cannot render, base axes")
        .def_property_readonly(
            "residual_torque", [](const Step& s) { return array(s.residual.torque); },
            "[N m] that the device cannot render, base axes, about the tool");
}

void bindStep(py::module_& module) {
    py::class_<Step> step(module, "Step", "The result of one step.");
    bindWrench(step);
    step.def_readonly("base_T_tool", &Step::baseTtool, "the tool, which never enters a forbidden region")
        .def_readonly("base_T_command", &Step::baseTcommand,
                      "tool pose that the hand commands, after hand map and clutch")
        .def_readonly("state", &Step::state, "a State")
        .def_property_readonly(
            "warnings",
            [](const Step& s) {
                return py::module_::import("fathom").attr("StepWarning")(static_cast<uint32_t>(s.warnings));
            },
            "StepWarning flags")
        .def_readonly("scene_age", &Step::sceneAge,
                      "[s] since the newest stamp of all frames; NaN before the first")
        .def_readonly("min_gap", &Step::minGap,
                      "[m] smallest gap of the contact set; its reach if none is nearer; NaN if unknown")
        .def_readonly("guidance", &Step::guidance, "weight of the guidance, 0..1")
        .def_readonly("frame", &Step::frame,
                      "index of the frame behind the active fixtures, counting dropped ones; -1 = none")
        .def_property_readonly(
            "joints", [](const Step& s) { return s.arm.joints; },
            "of the scene's arm [rad], of sliding joints [m]; 12 values, unused are 0")
        .def_property_readonly(
            "grasp", [](const Step& s) { return s.arm.grasp; }, "0 open .. 1 closed")
        .def_property_readonly(
            "contacts",
            [](const Step& s) {
                return std::vector<Contact>(s.contacts.begin(), s.contacts.begin() + s.contactCount);
            },
            "list of at most 8 Contact");
}

} // namespace

void bindHand(py::module_& module) {
    bindFlags(module);
    bindContact(module);
    bindStep(module);
    py::class_<HandPort>(module, "HandPort", "Computes the forces: Engine.open_hand(). One thread.")
        .def(
            "step",
            [](HandPort& port, const Pose& hand, uint32_t buttons, std::optional<Nanoseconds> time) {
                return port.step({hand, static_cast<Button>(buttons)}, time.value_or(now()));
            },
            py::arg("device_T_handle"), py::arg("buttons") = 0u, py::arg("now") = py::none(),
            "One step: the handle's pose in, a Step with the wrench out. Takes some 50 us.\n\n"
            "buttons: Button flags that are down. now: [ns] as fathom.now(); None = now.")
        .def_property_readonly("period", &HandPort::period, "[s] between steps that the scene asks for");
}

} // namespace fathom::python
