// SPDX-License-Identifier: Apache-2.0
// The old name of fathom/device_socket.h, for bridges that include it from the root of the sources.
#pragma once

#include "engine/include/fathom/device_socket.h"
