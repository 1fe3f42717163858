// SPDX-License-Identifier: Apache-2.0
// The layer that loses a GPU (tests/losing_layer), for programs started during its lifetime.
#pragma once

#include <cstdlib>
#include <string>
#include <vector>

namespace fathom {

class Losing {
public:
    // call: number of the call at which the loss occurs (AT counts submissions, DONE frames
    // whose passes have completed, TIMES timestamp readings);
    // by: "lost" or "memory".
    Losing(int call, const std::string& by, int refusedOpenings, const std::string& which = "AT") {
        begin(refusedOpenings);
        set("FATHOM_LOSE_" + which, std::to_string(call));
        set("FATHOM_LOSE_BY", by);
    }
    // Loses the device whenever the file `trigger` exists, and deletes it each time.
    Losing(const std::string& trigger, int refusedOpenings, const std::string& by = "lost") {
        begin(refusedOpenings);
        set("FATHOM_LOSE_FILE", trigger);
        set("FATHOM_LOSE_BY", by);
    }
    ~Losing() {
        for (const std::string& name : names_) {
            ::unsetenv(name.c_str());
        }
    }
    Losing(const Losing&) = delete;
    Losing& operator=(const Losing&) = delete;

private:
    void begin(int refusedOpenings) {
        set("VK_ADD_LAYER_PATH", LOSING_LAYER);
        set("VK_INSTANCE_LAYERS", "VK_LAYER_FATHOM_losing");
        set("FATHOM_LOSE_OPENINGS", std::to_string(refusedOpenings));
    }
    void set(const std::string& name, const std::string& value) {
        ::setenv(name.c_str(), value.c_str(), 1);
        names_.push_back(name);
    }
    std::vector<std::string> names_;
};

} // namespace fathom
