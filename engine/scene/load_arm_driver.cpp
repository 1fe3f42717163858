// SPDX-License-Identifier: Apache-2.0
// Section `arm.driver` of a scene file: the connection to a real arm.
#include "engine/scene/load.h"

namespace fathom {

namespace {

using Driver = SceneArm::Driver;

void loadAxes(const YamlNode& list, Driver& driver) {
    for (const YamlNode& row : list.list()) {
        row.checkKeys({"axis", "joint", "sign", "zero"});
        Driver::Axis axis;
        axis.axis = row.at("axis").text();
        axis.joint = row.at("joint").text();
        for (const Driver::Axis& before : driver.axes) {
            if (before.axis == axis.axis || before.joint == axis.joint) {
                row.refuse(axis.axis + " and " + axis.joint + " again", "each axis and each joint once");
            }
        }
        if (const auto sign = row.find("sign")) {
            axis.sign = sign->number(Range::between(-1.0, 1.0));
            if (axis.sign != 1.0 && axis.sign != -1.0) {
                sign->refuse("1 or -1");
            }
        }
        row.read("zero", axis.zero, Range::between(-10.0, 10.0));
        driver.axes.push_back(axis);
    }
}

} // namespace

SceneArm::Driver loadArmDriver(const YamlNode& node) {
    node.checkKeys({"protocol", "baud", "rs485", "axes", "jaws", "current"});
    Driver driver;
    driver.protocol = node.at("protocol")
                          .choice<Driver::Protocol>({{"reach_alpha5", Driver::Protocol::ReachAlpha5},
                                                     {"reach_bravo7", Driver::Protocol::ReachBravo7},
                                                     {"eca_5e", Driver::Protocol::Eca5e}});
    const bool reach = driver.protocol != Driver::Protocol::Eca5e;
    node.read("baud", driver.baud, 9600, 230400);
    node.read("rs485", driver.rs485);
    loadAxes(node.at("axes"), driver);
    if (const auto jaws = node.find("jaws")) {
        jaws->checkKeys({"open", "closed"});
        const Range range = reach ? Range::between(-0.1, 0.2) : Range::between(-10.0, 10.0);
        driver.jaws = Driver::Jaws{jaws->at("open").number(range), jaws->at("closed").number(range)};
        if (driver.jaws->open == driver.jaws->closed) {
            jaws->refuse("open " + jaws->at("open").value() + ", closed " + jaws->at("closed").value(),
                         "two different numbers");
        }
    }
    node.read("current", driver.current, reach ? Range::between(1e-3, 10.0) : Range::between(1.0, 255.0));
    return driver;
}

} // namespace fathom
