// SPDX-License-Identifier: Apache-2.0
// Lets GLSL and C++ share struct declarations. Members are only vec4, uvec4, float and uint, whose layouts
// agree.
#ifndef FATHOM_SHARED_INTEROP_H
#define FATHOM_SHARED_INTEROP_H

#ifdef __cplusplus
#include <cstdint>
#include <glm/vec4.hpp>
namespace fathom::shared {
using glm::uvec4;
using glm::vec4;
// GLSL's name.
using uint = uint32_t;
} // namespace fathom::shared
#define FATHOM_SHARED_BEGIN namespace fathom::shared {
#define FATHOM_SHARED_END }
#define FATHOM_CONST constexpr uint
#define FATHOM_SIZE(type, bytes)                                                                             \
    static_assert(sizeof(type) == bytes, #type " must have the size that GLSL gives it")
#else
#define FATHOM_SHARED_BEGIN
#define FATHOM_SHARED_END
#define FATHOM_CONST const uint
#define FATHOM_SIZE(type, bytes)
#endif

#endif
