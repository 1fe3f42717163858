// SPDX-License-Identifier: Apache-2.0
// An OpenNI2 driver with a synthetic camera: depth and colour of 32x24 pixels that encode the frame number,
// mirrored colour on request. URIs: fathom-test, fathom-test-mirrored, fathom-test-silent (three frames),
// fathom-test-plain (no field of view, colour not registered), fathom-test-apart (colour stamped 1 s late).
#include <Driver/OniDriverAPI.h>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>

// The export macro creates objects with these functions.
#define XN_NEW(type, ...) new type(__VA_ARGS__)
#define XN_DELETE(p) delete (p)

namespace {

constexpr int kWidth = 32, kHeight = 24;
constexpr OniPixelFormat kFormats[] = {ONI_PIXEL_FORMAT_DEPTH_1_MM, ONI_PIXEL_FORMAT_RGB888};

OniVideoMode modeOf(bool colour) {
    return {kFormats[colour ? 1 : 0], kWidth, kHeight, 30};
}

template <class T>
OniStatus give(const T& value, void* data, int* size) {
    if (*size < static_cast<int>(sizeof(T))) {
        return ONI_STATUS_BAD_PARAMETER;
    }
    std::memcpy(data, &value, sizeof(T));
    *size = sizeof(T);
    return ONI_STATUS_OK;
}

class Stream final : public oni::driver::StreamBase {
public:
    Stream(bool colour, const std::string& uri)
        : colour_(colour)
        , uri_(uri) {}
    ~Stream() override { stop(); }

    OniStatus start() override {
        stopping_ = false;
        thread_ = std::thread([this] { run(); });
        return ONI_STATUS_OK;
    }
    void stop() override {
        stopping_ = true;
        if (thread_.joinable()) {
            thread_.join();
        }
    }
    OniStatus getProperty(int id, void* data, int* size) override {
        switch (id) {
        case ONI_STREAM_PROPERTY_VIDEO_MODE:
            return give(modeOf(colour_), data, size);
        case ONI_STREAM_PROPERTY_STRIDE:
            return give(stride(), data, size);
        case ONI_STREAM_PROPERTY_CROPPING:
            return give(OniCropping{FALSE, 0, 0, 0, 0}, data, size);
        case ONI_STREAM_PROPERTY_MIRRORING:
            return give(OniBool(mirrored() ? TRUE : FALSE), data, size);
        case ONI_STREAM_PROPERTY_HORIZONTAL_FOV:
            return uri_ == "fathom-test-plain" ? ONI_STATUS_NOT_SUPPORTED : give(1.0f, data, size);
        case ONI_STREAM_PROPERTY_VERTICAL_FOV:
            return uri_ == "fathom-test-plain" ? ONI_STATUS_NOT_SUPPORTED : give(0.8f, data, size);
        case ONI_STREAM_PROPERTY_MAX_VALUE:
            return give(10000, data, size);
        default:
            return ONI_STATUS_NOT_SUPPORTED;
        }
    }
    OniStatus setProperty(int id, const void*, int) override {
        return id == ONI_STREAM_PROPERTY_VIDEO_MODE ? ONI_STATUS_OK : ONI_STATUS_NOT_SUPPORTED;
    }
    OniBool isPropertySupported(int id) override {
        char room[64];
        int size = sizeof room;
        return getProperty(id, room, &size) == ONI_STATUS_OK ? TRUE : FALSE;
    }
    void notifyAllProperties() override {
        for (const int id :
             {ONI_STREAM_PROPERTY_VIDEO_MODE, ONI_STREAM_PROPERTY_STRIDE, ONI_STREAM_PROPERTY_CROPPING,
              ONI_STREAM_PROPERTY_MIRRORING, ONI_STREAM_PROPERTY_HORIZONTAL_FOV,
              ONI_STREAM_PROPERTY_VERTICAL_FOV, ONI_STREAM_PROPERTY_MAX_VALUE}) {
            char room[64];
            int size = sizeof room;
            if (getProperty(id, room, &size) == ONI_STATUS_OK) {
                raisePropertyChanged(id, room, size);
            }
        }
    }

private:
    int stride() const { return kWidth * (colour_ ? 3 : 2); }
    bool mirrored() const { return uri_ == "fathom-test-mirrored"; }

    // Pixel (u, v) of frame n: depth 1000 + 40 v + u + n; red u, green v, blue n. Mirrored: columns reversed.
    void draw(OniFrame& frame, int n) const {
        auto* depth = static_cast<uint16_t*>(frame.data);
        auto* rgb = static_cast<uint8_t*>(frame.data);
        for (int v = 0; v < kHeight; ++v) {
            for (int u = 0; u < kWidth; ++u) {
                const int at = v * kWidth + (mirrored() ? kWidth - 1 - u : u);
                if (colour_) {
                    rgb[3 * at] = static_cast<uint8_t>(u), rgb[3 * at + 1] = static_cast<uint8_t>(v);
                    rgb[3 * at + 2] = static_cast<uint8_t>(n);
                } else {
                    depth[at] = static_cast<uint16_t>(1000 + 40 * v + u + n);
                }
            }
        }
    }
    void run() {
        for (int n = 1; !stopping_ && (uri_ != "fathom-test-silent" || n <= 3); ++n) {
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            OniFrame* frame = getServices().acquireFrame();
            if (frame == nullptr) {
                continue;
            }
            frame->frameIndex = n;
            frame->videoMode = modeOf(colour_);
            frame->width = kWidth, frame->height = kHeight;
            frame->cropOriginX = frame->cropOriginY = 0;
            frame->croppingEnabled = FALSE;
            frame->stride = stride();
            frame->dataSize = stride() * kHeight;
            frame->sensorType = colour_ ? ONI_SENSOR_COLOR : ONI_SENSOR_DEPTH;
            frame->timestamp = static_cast<uint64_t>(n) * 33333;
            frame->timestamp += colour_ && uri_ == "fathom-test-apart" ? 1000000 : 0;
            draw(*frame, n);
            raiseNewFrame(frame);
            getServices().releaseFrame(frame);
        }
    }

    bool colour_;
    std::string uri_;
    std::atomic<bool> stopping_{false};
    std::thread thread_;
};

class Camera final : public oni::driver::DeviceBase {
public:
    explicit Camera(std::string uri)
        : uri_(std::move(uri)) {
        for (int i = 0; i < 2; ++i) {
            modes_[i] = modeOf(i == 1);
            sensors_[i] = {i == 1 ? ONI_SENSOR_COLOR : ONI_SENSOR_DEPTH, 1, &modes_[i]};
        }
    }
    OniStatus getSensorInfoList(OniSensorInfo** sensors, int* count) override {
        *sensors = sensors_;
        *count = 2;
        return ONI_STATUS_OK;
    }
    oni::driver::StreamBase* createStream(OniSensorType type) override {
        return new Stream(type == ONI_SENSOR_COLOR, uri_);
    }
    void destroyStream(oni::driver::StreamBase* stream) override { delete stream; }
    OniStatus getProperty(int id, void* data, int* size) override {
        return id == ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION ? give(registration_, data, size)
                                                            : ONI_STATUS_NOT_SUPPORTED;
    }
    OniStatus setProperty(int id, const void* data, int size) override {
        if (id != ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION || size != sizeof registration_) {
            return ONI_STATUS_NOT_SUPPORTED;
        }
        std::memcpy(&registration_, data, sizeof registration_);
        return ONI_STATUS_OK;
    }
    OniBool isPropertySupported(int id) override {
        return id == ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION ? TRUE : FALSE;
    }
    void notifyAllProperties() override {
        raisePropertyChanged(ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION, &registration_, sizeof registration_);
    }
    OniBool isImageRegistrationModeSupported(OniImageRegistrationMode) override {
        return uri_ == "fathom-test-plain" ? FALSE : TRUE;
    }

private:
    std::string uri_;
    OniVideoMode modes_[2];
    OniSensorInfo sensors_[2];
    OniImageRegistrationMode registration_ = ONI_IMAGE_REGISTRATION_OFF;
};

class Driver final : public oni::driver::DriverBase {
public:
    explicit Driver(OniDriverServices* services)
        : DriverBase(services) {}
    // A camera that the test plugs in.
    OniStatus initialize(oni::driver::DeviceConnectedCallback connected,
                         oni::driver::DeviceDisconnectedCallback gone,
                         oni::driver::DeviceStateChangedCallback changed, void* cookie) override {
        const OniStatus done = DriverBase::initialize(connected, gone, changed, cookie);
        if (std::getenv("FATHOM_TEST_PLUGGED") != nullptr) {
            OniDeviceInfo info{};
            std::strncpy(info.uri, "fathom-test", sizeof info.uri - 1);
            std::strncpy(info.name, "drawn camera", sizeof info.name - 1);
            info.usbVendorId = 0x1d27;
            info.usbProductId = 0x0601;
            deviceConnected(&info);
        }
        return done;
    }
    OniStatus tryDevice(const char* uri) override {
        if (std::string(uri).rfind("fathom-test", 0) != 0) {
            return ONI_STATUS_ERROR;
        }
        OniDeviceInfo info{};
        std::strncpy(info.uri, uri, sizeof info.uri - 1);
        std::strncpy(info.name, "drawn camera", sizeof info.name - 1);
        deviceConnected(&info);
        return ONI_STATUS_OK;
    }
    oni::driver::DeviceBase* deviceOpen(const char* uri, const char*) override { return new Camera(uri); }
    void deviceClose(oni::driver::DeviceBase* device) override { delete device; }
    void shutdown() override {}
};

} // namespace

ONI_EXPORT_DRIVER(Driver)
