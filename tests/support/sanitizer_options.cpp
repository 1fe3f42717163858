// SPDX-License-Identifier: Apache-2.0
// Memory that the font library, the Vulkan layers and the software driver keep until the process ends, and
// that the mesh reader loses over a broken file, is not a leak of the tests. The thread sanitizer does not
// see the atomic reference counts of the software driver's fences, so it reports their destruction as a race.
#ifdef FATHOM_SANITIZED
// The sanitizer's runtime looks it up by name: it must stay visible where symbols are hidden by default.
extern "C" __attribute__((visibility("default"))) const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
    return "leak:libfontconfig\nleak:libVkLayer\nleak:libvulkan\nleak:libLLVM\nleak:libassimp\n";
}

extern "C" __attribute__((visibility("default"))) const char* __tsan_default_suppressions();
extern "C" const char* __tsan_default_suppressions() {
    return "race:libvulkan_lvp.so\n";
}
#endif
