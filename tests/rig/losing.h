// SPDX-License-Identifier: Apache-2.0
// The layer that loses a GPU (tests/losing_layer), under the programs that are started while this lives.
#pragma once

#include <cstdlib>
#include <string>
#include <vector>

namespace fathom {

class Losing {
public:
    // By the number of a call (AT: a submission, TIMES: a reading of the stopwatch); by: "lost" or "memory".
    Losing(int call, const std::string& by, int refusedOpenings, const std::string& which = "AT") {
        begin(refusedOpenings);
        set("FATHOM_LOSE_" + which, std::to_string(call));
        set("FATHOM_LOSE_BY", by);
    }
    // As soon as `trigger` exists, which goes when it is done: again and again.
    Losing(const std::string& trigger, int refusedOpenings) {
        begin(refusedOpenings);
        set("FATHOM_LOSE_FILE", trigger);
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
