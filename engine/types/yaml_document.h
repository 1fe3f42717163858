// SPDX-License-Identifier: Apache-2.0
// Parses YAML that must be one document.
#pragma once

#include <string>
#include <yaml-cpp/yaml.h>

namespace fathom {

// `file` is for messages. Throws YAML::Exception for a syntax error, BadInput for a second document or for
// a tag that YAML itself does not define.
YAML::Node onlyYamlDocument(const std::string& file, const std::string& text);

} // namespace fathom
