#pragma once

#include <nlohmann/json.hpp>
#include <string>

/// The tables of the pages in protocol/, from the JSON Schema.
namespace page_tables {

/// The page with each marked region written anew. A region stands between these lines, each with an empty
/// line on its inner side; NAME is a definition of the schema, or a member of one (`stateDocument.camera`):
///
///     <!-- Members of NAME, written by test_protocol. -->
///     <!-- End of members. -->
std::string filled(std::string page, const nlohmann::json& definitions);

/// What stands in the region NAME.
std::string region(const std::string& name, const nlohmann::json& definitions);

}  // namespace page_tables
