// SPDX-License-Identifier: Apache-2.0
// Requests to the layer from the environment and a file, and the surfaces that it has lost. Every call
// requires the layer's mutex.
#pragma once

#include <vulkan/vulkan.h>

namespace losing {

long number(const char* name);   // number in an environment variable; 0 = unset
VkResult lossOf();               // the result that a lost device returns
bool askedFor(const char* call); // whether the file names this call; removes the file then

// A lost surface gets no images until it is destroyed.
void hasImages(VkSurfaceKHR surface);     // marks it as the newest surface with images
void loseSurface();                       // loses the newest surface
VkResult refusalOf(VkSurfaceKHR surface); // why it gets no images; VK_SUCCESS: it does
void forget(VkSurfaceKHR surface);

} // namespace losing
