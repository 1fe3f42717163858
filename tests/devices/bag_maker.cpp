// SPDX-License-Identifier: Apache-2.0
#include "tests/devices/bag_maker.h"

#include <bzlib.h>
#include <lz4frame.h>

namespace fathom::testing {

namespace {

std::string packed(const std::string& bytes, const std::string& compression) {
    std::string out(bytes.size() + 4096, 0);
    if (compression == "lz4") {
        out.resize(LZ4F_compressFrame(out.data(), out.size(), bytes.data(), bytes.size(), nullptr));
    } else if (compression == "bz2") {
        auto size = static_cast<unsigned>(out.size());
        BZ2_bzBuffToBuffCompress(out.data(), &size, const_cast<char*>(bytes.data()),
                                 static_cast<unsigned>(bytes.size()), 1, 0, 0);
        out.resize(size);
    } else {
        return bytes;
    }
    return out;
}

} // namespace

std::string bagRecord(const std::vector<std::pair<std::string, std::string>>& fields,
                      const std::string& data) {
    Out header;
    for (const auto& [name, value] : fields) {
        header.text(name + "=" + value);
    }
    return Out().text(header.bytes).text(data).bytes;
}

void BagMaker::add(const std::string& topic, const std::string& type, double t, const std::string& message) {
    uint32_t conn = 0;
    while (conn < topics_.size() && topics_[conn].first != topic) {
        ++conn;
    }
    if (conn == topics_.size()) {
        topics_.emplace_back(topic, type);
        index_.emplace_back();
        chunk_ += connection(conn);
    }
    const auto seconds = static_cast<uint32_t>(t),
               nanos = static_cast<uint32_t>(std::lround((t - seconds) * 1e9));
    const std::string time = Out().put(seconds).put(nanos).bytes;
    index_[conn] += time + raw(static_cast<uint32_t>(chunk_.size()));
    chunk_ += bagRecord({{"op", "\x02"}, {"conn", raw(conn)}, {"time", time}}, message);
}

std::string BagMaker::headAt(uint64_t indexAt) const {
    return "#ROSBAG V2.0\n" + bagRecord({{"op", "\x03"},
                                         {"index_pos", raw(indexAt)},
                                         {"conn_count", raw(static_cast<uint32_t>(topics_.size()))},
                                         {"chunk_count", raw(uint32_t{1})}},
                                        std::string(64, ' '));
}

std::string BagMaker::chunkRecord(const std::string& compression) const {
    return bagRecord(
        {{"op", "\x05"}, {"compression", compression}, {"size", raw(static_cast<uint32_t>(chunk_.size()))}},
        packed(chunk_, compression));
}

std::string BagMaker::bag(const std::string& compression, bool indexed) const {
    std::string body = chunkRecord(compression), tail;
    for (uint32_t conn = 0; conn < topics_.size(); ++conn) {
        body += bagRecord({{"op", "\x04"}, {"conn", raw(conn)}}, index_[conn]);
        tail += connection(conn);
    }
    tail += bagRecord({{"op", "\x06"}, {"chunk_pos", raw(uint64_t{headSize()})}}, "");
    return headAt(indexed ? headSize() + body.size() : 0) + body + tail;
}

std::string BagMaker::chunks(const std::string& compression, bool head) const {
    return (head ? headAt(0) : "") + chunkRecord(compression);
}

std::string BagMaker::begunChunk() const {
    return bagRecord({{"op", "\x05"}, {"compression", "none"}, {"size", raw(uint32_t{0})}}, "") + chunk_;
}

size_t BagMaker::headSize() const {
    return headAt(0).size();
}

std::string BagMaker::connection(uint32_t conn) const {
    return bagRecord({{"op", "\x07"}, {"conn", raw(conn)}, {"topic", topics_[conn].first}},
                     Out().text("type=" + topics_[conn].second).bytes);
}

std::string stampedHeader(double t, const std::string& frame) {
    return Out()
        .put(uint32_t{7})
        .put(static_cast<uint32_t>(t))
        .put(static_cast<uint32_t>(std::lround((t - std::floor(t)) * 1e9)))
        .text(frame)
        .bytes;
}

std::string imageMessage(double t, const ImageMessage& image) {
    const uint32_t step =
        image.step > 0 ? image.step : static_cast<uint32_t>(image.pixels.size()) / image.height;
    return stampedHeader(t, image.frame) + Out()
                                               .put(image.height)
                                               .put(image.width)
                                               .text(image.encoding)
                                               .put(static_cast<uint8_t>(image.bigEndian))
                                               .put(step)
                                               .text(image.pixels)
                                               .bytes;
}

std::string compressedMessage(double t, const std::string& frame, const std::string& format,
                              const std::string& data) {
    return stampedHeader(t, frame) + Out().text(format).text(data).bytes;
}

std::string infoMessage(const InfoMessage& info) {
    Out out;
    out.bytes = stampedHeader(0, info.frame);
    out.put(info.height).put(info.width).text(info.model).put(static_cast<uint32_t>(info.distortion.size()));
    for (const double d : info.distortion) {
        out.put(d);
    }
    for (const double k : {info.k[0], info.skew, info.k[2], 0.0, info.k[1], info.k[3], 0.0, 0.0, 1.0}) {
        out.put(k);
    }
    for (const double r : {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}) {
        out.put(r);
    }
    for (const double p :
         {info.p[0], 0.0, info.p[2], info.tx, 0.0, info.p[1], info.p[3], 0.0, 0.0, 0.0, 1.0, 0.0}) {
        out.put(p);
    }
    out.put(info.binning).put(info.binning);
    for (const uint32_t edge : info.roi) {
        out.put(edge);
    }
    return out.put(uint8_t{0}).bytes;
}

std::string transformMessage(double x, double y, double z) {
    Out out;
    for (const double value : {x, y, z, 0.0, 0.0, 0.0, 1.0}) {
        out.put(value);
    }
    return out.bytes;
}

std::string filledColour(uint8_t r, uint8_t g, uint8_t b, uint32_t count) {
    std::string all;
    for (uint32_t i = 0; i < count; ++i) {
        all += {static_cast<char>(r), static_cast<char>(g), static_cast<char>(b)};
    }
    return all;
}

void addStream(BagMaker& maker, const std::string& topic, const ImageMessage& image, const InfoMessage& info,
               const std::vector<double>& times) {
    const std::string parent = topic.substr(0, topic.rfind('/'));
    maker.add(parent + "/camera_info", "sensor_msgs/CameraInfo", times.front(), infoMessage(info));
    for (const double t : times) {
        maker.add(topic, "sensor_msgs/Image", t, imageMessage(t, image));
    }
}

} // namespace fathom::testing
