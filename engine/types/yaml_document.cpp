// SPDX-License-Identifier: Apache-2.0
#include "engine/types/yaml_document.h"

#include "engine/types/error.h"

#include <sstream>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/parser.h>

namespace fathom {

namespace {

// Records where each document begins, and rejects tags of other programs: xacro's !degrees would be read as
// if it were not there.
class DocumentEvents : public YAML::EventHandler {
public:
    explicit DocumentEvents(const std::string& file)
        : file_(file) {}
    int last = 0; // line of the last document, from 0

    void OnDocumentStart(const YAML::Mark& mark) override { last = mark.line; }
    void OnDocumentEnd() override {}
    void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
    void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
    void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                  const std::string&) override {
        check(mark, tag);
    }
    void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                         YAML::EmitterStyle::value) override {
        check(mark, tag);
    }
    void OnSequenceEnd() override {}
    void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                    YAML::EmitterStyle::value) override {
        check(mark, tag);
    }
    void OnMapEnd() override {}

private:
    void check(const YAML::Mark& mark, const std::string& tag) const {
        // "?" is a plain value, "!" one in quotes.
        if (!tag.empty() && tag != "?" && tag != "!" && !tag.starts_with("tag:yaml.org,2002:")) {
            throw BadInput(file_, "line " + std::to_string(mark.line + 1), "tag '" + excerpt(tag) + "'",
                           "values without a tag; angles in rad");
        }
    }

    const std::string& file_;
};

} // namespace

// YAML::LoadAll allocates without bound when the first document is followed by text that starts none, such as
// a comma, because the parser makes no progress.
YAML::Node onlyYamlDocument(const std::string& file, const std::string& text) {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    DocumentEvents events(file);
    if (parser.HandleNextDocument(events) && parser.HandleNextDocument(events)) {
        throw BadInput(file, "line " + std::to_string(events.last + 1), "more than a YAML document",
                       "one document");
    }
    return YAML::Load(text);
}

} // namespace fathom
