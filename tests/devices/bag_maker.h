// SPDX-License-Identifier: Apache-2.0
// Makes small ROS 1 bags and the messages in them.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace fathom::testing {

// Bytes as ROS 1 serialises them.
struct Out {
    std::string bytes;
    template <class T>
    Out& put(T value) {
        bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
        return *this;
    }
    Out& text(const std::string& s) {
        put(static_cast<uint32_t>(s.size()));
        bytes += s;
        return *this;
    }
};

template <class T>
std::string raw(T value) {
    return Out().put(value).bytes;
}

std::string bagRecord(const std::vector<std::pair<std::string, std::string>>& fields,
                      const std::string& data);

// A bag with one chunk, written by the format's page.
class BagMaker {
public:
    void add(const std::string& topic, const std::string& type, double t, const std::string& message);
    std::string bag(const std::string& compression = "none", bool indexed = true) const;
    // As a crash leaves a bag: header, and the chunk without indexes. head = false: the chunk alone.
    std::string chunks(const std::string& compression, bool head = true) const;
    std::string begunChunk() const; // as a recorder has written it before it states the chunk's size
    size_t headSize() const;        // of a bag [bytes]

private:
    std::string headAt(uint64_t indexAt) const;
    std::string chunkRecord(const std::string& compression) const;
    std::string connection(uint32_t conn) const;

    std::vector<std::pair<std::string, std::string>> topics_;
    std::vector<std::string> index_;
    std::string chunk_;
};

std::string stampedHeader(double t, const std::string& frame);

struct ImageMessage {
    std::string frame = "camera", encoding = "16UC1";
    uint32_t width = 8, height = 6, step = 0; // step 0: rows without gaps
    std::string pixels;
    bool bigEndian = false; // as stated
};
std::string imageMessage(double t, const ImageMessage& image);
std::string compressedMessage(double t, const std::string& frame, const std::string& format,
                              const std::string& data);

struct InfoMessage {
    std::string frame = "camera", model = "plumb_bob";
    uint32_t width = 8, height = 6;
    std::vector<double> distortion;
    std::array<double, 4> k{7.0, 7.0, 3.5, 2.5}, p{}; // fx, fy, cx, cy
    uint32_t binning = 0;
    std::array<uint32_t, 4> roi{}; // x, y, height, width
    double tx = 0.0;               // P[3], if p is given
    double skew = 0.0;             // K[1]
};
std::string infoMessage(const InfoMessage& info);
std::string transformMessage(double x, double y, double z); // geometry_msgs/Transform without rotation

// The same pixel everywhere.
template <class T>
std::string filled(T pixel, uint32_t count = 48) {
    std::string all;
    for (uint32_t i = 0; i < count; ++i) {
        all += raw(pixel);
    }
    return all;
}
std::string filledColour(uint8_t r, uint8_t g, uint8_t b, uint32_t count = 48);

// An image topic and its camera_info; images at the given times, all alike.
void addStream(BagMaker& maker, const std::string& topic, const ImageMessage& image,
               const InfoMessage& info = {}, const std::vector<double>& times = {1.0, 1.1, 1.2});

} // namespace fathom::testing
