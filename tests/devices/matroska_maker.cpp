// SPDX-License-Identifier: Apache-2.0
#include "tests/devices/matroska_maker.h"

#include "tests/devices/bag_maker.h"

namespace fathom::testing {

namespace {

std::string bigEndianBytes(uint64_t value, int count) {
    std::string bytes;
    for (int i = count - 1; i >= 0; --i) {
        bytes += static_cast<char>(value >> (8 * i));
    }
    return bytes;
}

std::string trackEntry(const MkvTrack& track) {
    // BITMAPINFOHEADER: size, width, height, planes, bits; the code; five numbers.
    Out header;
    header.put(uint32_t{40}).put(track.width).put(track.height).put(uint16_t{1}).put(uint16_t{16});
    header.bytes += track.fourcc;
    header.bytes.resize(40);
    const std::string video = ebmlNumberElement(0xB0, track.width) + ebmlNumberElement(0xBA, track.height);
    return ebml(0xAE, ebmlNumberElement(0xD7, track.number) + ebmlNumberElement(0x73C5, track.uid) +
                          ebmlNumberElement(0x83, 1) + ebml(0x536E, track.name) +
                          ebml(0x86, "V_MS/VFW/FOURCC") + ebml(0x63A2, header.bytes) + ebml(0xE0, video) +
                          track.more);
}

std::string blockData(const MkvBlock& block) {
    return std::string(1, static_cast<char>(0x80 | block.track)) + std::string(3, '\0') + block.data;
}

} // namespace

std::string ebml(uint32_t id, const std::string& data, bool sized) {
    const int length = id > 0xFFFFFF ? 4 : (id > 0xFFFF ? 3 : (id > 0xFF ? 2 : 1));
    const std::string size =
        sized ? '\x01' + bigEndianBytes(data.size(), 7) : "\x01" + std::string(7, '\xff');
    return bigEndianBytes(id, length) + size + data;
}

std::string ebmlNumberElement(uint32_t id, uint64_t value) {
    return ebml(id, bigEndianBytes(value, 8));
}

std::string MkvFile::cluster(size_t block) const {
    const std::string data = blockData(blocks[block]);
    return ebml(0x1F43B675,
                ebml(0xBF, "crc.") + ebmlNumberElement(0xE7, blocks[block].time) +
                    (block % 2 == 0 ? ebml(0xA3, data) : ebml(0xA0, ebml(0xA1, data))),
                sized);
}

std::string MkvFile::bytes() const {
    std::string entries, all;
    for (const MkvTrack& track : tracks) {
        entries += trackEntry(track);
    }
    std::string named;
    for (const auto& [name, text] : tags) {
        named += ebml(0x7373, ebml(0x63C0, "") + ebml(0x67C8, ebml(0x45A3, name) + ebml(0x4487, text)));
    }
    std::string segment = ebml(0x114D9B74, "") + ebml(0xEC, std::string(9, '\0')) +
                          ebml(0x1549A966, ebmlNumberElement(0x2AD7B1, 1000)) + ebml(0x1654AE6B, entries) +
                          ebml(0x1254C367, named);
    if (!calibration.empty()) {
        segment +=
            ebml(0x1941A469, ebml(0x61A7, ebml(0x466E, "calibration.json") + ebml(0x465C, calibration)));
    }
    for (size_t i = 0; i < blocks.size(); ++i) {
        segment += cluster(i);
    }
    return ebml(0x1A45DFA3, ebml(0x4282, "matroska")) + ebml(0x18538067, segment, sized);
}

std::string kinectCalibration(const KinectLenses& lenses) {
    const auto camera = [&](const std::string& location, const std::string& numbers, const std::string& pose,
                            const std::string& size) {
        return R"({"Intrinsics":{"ModelParameterCount":15,"ModelParameters":)" + numbers +
               R"(,"ModelType":")" + lenses.model + R"("},"Location":"CALIBRATION_CameraLocation)" +
               location + R"(","Rt":{)" + pose + "}," + size + "}";
    };
    return R"({"CalibrationInformation":{"Cameras":[)" +
           camera("D0", lenses.depth, R"("Rotation":[1,0,0,0,1,0,0,0,1],"Translation":[0,0,0])",
                  R"("SensorWidth":1024,"SensorHeight":1024)") +
           "," +
           camera("PV0", lenses.colour,
                  R"("Rotation":)" + lenses.rotation + R"(,"Translation":)" + lenses.translation,
                  lenses.colourSize) +
           "]}}";
}

} // namespace fathom::testing
