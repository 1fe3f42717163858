// SPDX-License-Identifier: Apache-2.0
#include "engine/types/yaml_document.h"

#include "engine/types/error.h"

#include <sstream>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/parser.h>

namespace fathom {

namespace {

// Records where each document begins.
class DocumentStarts : public YAML::EventHandler {
public:
    int last = 0; // line, from 0

    void OnDocumentStart(const YAML::Mark& mark) override { last = mark.line; }
    void OnDocumentEnd() override {}
    void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
    void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
    void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t, const std::string&) override {}
    void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                         YAML::EmitterStyle::value) override {}
    void OnSequenceEnd() override {}
    void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                    YAML::EmitterStyle::value) override {}
    void OnMapEnd() override {}
};

} // namespace

// YAML::LoadAll allocates without bound when the first document is followed by text that starts none, such as
// a comma, because the parser makes no progress.
YAML::Node onlyYamlDocument(const std::string& file, const std::string& text) {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    DocumentStarts starts;
    if (parser.HandleNextDocument(starts) && parser.HandleNextDocument(starts)) {
        throw BadInput(file, "line " + std::to_string(starts.last + 1), "more than a YAML document",
                       "one document");
    }
    return YAML::Load(text);
}

} // namespace fathom
