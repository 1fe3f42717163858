// SPDX-License-Identifier: Apache-2.0
/// @file
/// Depth cameras: lenses and formats, frames, and the port that takes the frames.
#pragma once

#include <fathom/types.h>

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace fathom::v0 {

/// Format of depth images: rows without gaps, from the top left pixel.
enum class DepthFormat {
    Uint16, ///< one value times CameraModel::metresPerUnit is the distance along the optical axis; 0 = no
            ///< measurement
    Metres  ///< float [m], rounded to 0.1 mm if the scene's `camera.far` is at most 6.5535 m. Otherwise the
    ///< unit is the least multiple of 0.1 mm whose 65535 steps reach `camera.far`. Zero, negative, not
    ///< finite or beyond 65535 steps = no measurement: such points are not protected
};

/// Format of colour images: rows without gaps, from the top left pixel.
enum class ColourFormat {
    None,
    Rgb,  ///< 3 bytes per pixel
    Rgba, ///< 4 bytes per pixel, 4-byte aligned; alpha is ignored
    Yuyv  ///< 2 bytes per pixel, 4-byte aligned, even width
};

/// Pinhole lens with Brown-Conrady distortion. Pixel (0, 0) is the centre of the first pixel.
struct Intrinsics {
    std::uint32_t width = 0;            ///< [pixels]
    std::uint32_t height = 0;           ///< [pixels]
    double fx = 0.0;                    ///< [pixels] focal length along x
    double fy = 0.0;                    ///< [pixels] focal length along y
    double cx = 0.0;                    ///< [pixels] principal point
    double cy = 0.0;                    ///< [pixels] principal point
    std::array<double, 5> distortion{}; ///< k1 k2 p1 p2 k3; all zero = none
};

/// Camera frames have z forward, x right, y down.
struct CameraModel {
    std::string name = "camera";                    ///< for Engine::camera() and messages
    Intrinsics depth{};                             ///< lens of the depth images
    DepthFormat depthFormat = DepthFormat::Uint16;  ///< of Frame::depth
    double metresPerUnit = 0.001;                   ///< of DepthFormat::Uint16
    ColourFormat colourFormat = ColourFormat::None; ///< of Frame::colour
    /// The colour lens, if colour is not registered to depth. Empty: colour pixel (u, v) shows depth pixel
    /// (u, v).
    std::optional<Intrinsics> colour{};
    Pose colourTdepth{}; ///< from the depth camera to the colour camera; used with `colour` only
};

/// One frame. The pointers must stay valid during submit() only.
struct Frame {
    const void* depth = nullptr;  ///< width x height values of the camera's depth format
    const void* colour = nullptr; ///< of the colour format; null if the format is None
    Pose baseTcamera{};           ///< the depth camera in the base frame when the frame was taken
    Nanoseconds stamp = 0;        ///< when it was taken (start of exposure)
};

/// What became of a submitted frame. Only Accepted frames are processed.
enum class SubmitStatus {
    Accepted,
    MissingStamp, ///< the stamp is zero or negative
    StampAhead,   ///< the stamp is more than 5 ms ahead of now: different clock?
    StampBack,    ///< the stamp is not later than the one before: call clockJumped() first if it may be
    MissingImage, ///< a pointer is null or not aligned for its format
    BadPose,      ///< the pose is not finite or not within 1000 km, or its quaternion is zero
    Closed        ///< the engine is destroyed, or its frame thread failed: see Engine::failure()
};

/// The enumerator's name, for messages: "StampAhead". Any thread.
FATHOM_API const char* name(SubmitStatus status) noexcept;

/// Takes the frames of one camera. A handle that you may copy, and that may outlive its engine. Moving
/// copies: a moved-from port stays usable. submit(), lend() and clockJumped() belong to one thread, the
/// camera thread.
class FATHOM_API CameraPort {
public:
    /// Copies the frame and returns. The newest frame wins: one that still waits is dropped and counted.
    /// Shares one short lock with the engine's frame thread. It never blocks HandPort::step(). @throws
    /// std::bad_alloc
    [[nodiscard]] SubmitStatus submit(const Frame& frame);

    /// Lends the frame instead of copying it. Its memory must stay valid and unchanged until release() is
    /// called, exactly once per call of lend(), from this call, a later submit() or lend(), the frame thread
    /// or the engine's destructor. It must not throw. The frame is copied, and release() is called at once,
    /// for DepthFormat::Metres and for scenes with `camera.decimation` above 1 or a flat window
    /// (`camera.port`). Takes the lock of submit(). @throws std::bad_alloc
    [[nodiscard]] SubmitStatus lend(const Frame& frame, std::function<void()> release);

    /// The next stamp may be earlier than the last one, for example after your conversion to CLOCK_MONOTONIC
    /// was corrected.
    void clockJumped() noexcept;

    std::uint64_t dropped() const noexcept;   ///< frames that a newer one replaced. Any thread.
    std::uint64_t processed() const noexcept; ///< frames that became a fixture set. Any thread.

    CameraPort(const CameraPort&) noexcept = default;            ///< of the same camera
    CameraPort& operator=(const CameraPort&) noexcept = default; ///< likewise

    struct FATHOM_LOCAL Impl;
    explicit CameraPort(std::shared_ptr<Impl> impl) noexcept; ///< for the library itself

private:
    std::shared_ptr<Impl> impl_;
};

} // namespace fathom::v0
