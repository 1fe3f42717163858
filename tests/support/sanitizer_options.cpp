// SPDX-License-Identifier: Apache-2.0
// What the font library, the Vulkan layers and the software driver keep, and the mesh
// reader loses over a broken file, until the process ends is not ours
// and no leak of a test.
#ifdef FATHOM_SANITIZED
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
    return "leak:libfontconfig\nleak:libVkLayer\nleak:libvulkan\nleak:libLLVM\nleak:libassimp\n";
}
#endif
