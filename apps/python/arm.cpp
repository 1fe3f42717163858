// SPDX-License-Identifier: Apache-2.0
// A real arm that follows the scene's arm.
#include "apps/python/bind.h"

#include <algorithm>
#include <optional>

namespace py = pybind11;

namespace fathom::python {

namespace {

ReportStatus report(ArmPort& port, const std::vector<double>& joints, double grasp,
                    std::optional<Nanoseconds> stamp, bool ready) {
    if (joints.size() != port.joints()) {
        throw py::value_error("joints: " + std::to_string(joints.size()) + " values (allowed: " +
                              std::to_string(port.joints()) + ", one per moving joint)");
    }
    MeasuredArm arm;
    std::copy(joints.begin(), joints.end(), arm.posture.joints.begin());
    arm.posture.grasp = grasp;
    arm.stamp = stamp.value_or(now());
    arm.ready = ready;
    return port.report(arm);
}

std::vector<std::string> names(const ArmPort& port) {
    std::vector<std::string> all;
    for (size_t i = 0; i < port.joints(); ++i) {
        all.push_back(port.jointName(i));
    }
    return all;
}

} // namespace

void bindArm(py::module_& module) {
    py::enum_<ReportStatus>(module, "ReportStatus", "What became of a report.")
        .value("ACCEPTED", ReportStatus::Accepted)
        .value("MISSING_STAMP", ReportStatus::MissingStamp, "zero or negative")
        .value("STAMP_AHEAD", ReportStatus::StampAhead, "more than 5 ms ahead of now()")
        .value("STAMP_BACK", ReportStatus::StampBack, "not later than the one before")
        .value("BAD_POSTURE", ReportStatus::BadPosture, "a joint is not finite");
    py::class_<ArmSetpoint>(module, "ArmSetpoint", "Where the real arm should be.")
        .def_property_readonly(
            "joints", [](const ArmSetpoint& s) { return s.posture.joints; },
            "[rad], of sliding joints [m]; 12 values, unused are 0")
        .def_property_readonly("grasp", [](const ArmSetpoint& s) { return s.posture.grasp; })
        .def_readonly("hold", &ArmSetpoint::hold, "stand still; the posture is meaningless")
        .def_readonly("forces_off", &ArmSetpoint::forcesOff, "the pilot has switched forces off")
        .def_readonly("stamp", &ArmSetpoint::stamp, "[ns] `now` of the step; 0 = no step yet");
    py::class_<ArmPort>(module, "ArmPort", "Connects a real arm: Engine.open_arm(). One thread.")
        .def("report", &report, py::arg("joints"), py::arg("grasp") = 0.0, py::kw_only(),
             py::arg("stamp") = py::none(), py::arg("ready") = true,
             "Reports measured joints [rad, m], from base to tip. ready=False: the arm cannot follow.")
        .def("setpoint", &ArmPort::setpoint, "The newest ArmSetpoint.")
        .def_property_readonly("names", &names, "of the moving joints, as in the URDF");
}

} // namespace fathom::python
