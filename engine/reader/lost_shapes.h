// SPDX-License-Identifier: Apache-2.0
// Finds collision shapes of a URDF that urdfdom drops: it keeps a link without what it could not parse, and
// without all that follows in it.
#pragma once

#include <string>
#include <urdf_model/model.h>
#include <vector>

namespace fathom {

// Throws BadInput that names the link, the element and the reason when a link of the model has fewer shapes
// than the text. errors: of the parser, in order.
void refuseLostShapes(const urdf::ModelInterface& model, const std::string& text, const std::string& file,
                      const std::vector<std::string>& errors);

} // namespace fathom
