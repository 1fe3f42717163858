// SPDX-License-Identifier: Apache-2.0
// Another program of the graph, in a process of its own, driven by lines.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <sys/types.h>
#include <vector>

class Peer {
public:
    // arguments: without the program's name.
    Peer(const std::string& program, const std::vector<std::string>& arguments);
    ~Peer(); // kills it
    Peer(const Peer&) = delete;
    Peer& operator=(const Peer&) = delete;

    void send(const std::string& line) const;
    void stop() const; // SIGSTOP: it reads nothing any more
    // Its next line of output; none when it has ended, or wrote none for so long.
    std::optional<std::string> line(std::chrono::seconds most = std::chrono::seconds(60));

private:
    pid_t process_ = 0;
    int in_ = -1, out_ = -1;
    std::string rest_; // read, but no whole line yet
};

// A domain that this process holds until it ends, so that test programs that run at once do not meet.
uint32_t testDomain();
