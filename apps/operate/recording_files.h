// SPDX-License-Identifier: Apache-2.0
// Files of a recording as `replay` reads them: pictures and lenses.
#pragma once

#include "engine/types/camera_info.h"

#include <filesystem>
#include <span>
#include <string>

namespace fathom::operate {

std::string sixDigits(uint32_t number);

// Each throws Error that names the file. depth: raw units; colour: 0xAABBGGRR.
void writeDepthPng(const std::filesystem::path& file, uint32_t width, uint32_t height,
                   std::span<const uint16_t> depth);
void writeColourPng(const std::filesystem::path& file, uint32_t width, uint32_t height,
                    std::span<const uint32_t> colour);
void writeIntrinsics(const std::filesystem::path& file, const CameraInfo& camera);

} // namespace fathom::operate
