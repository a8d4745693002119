#pragma once

#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "messages.hpp"
#include "state.hpp"

namespace vrut::protocol {

/// A presentation as a file.
struct CueList {
    static constexpr int kVersion = 1;
    enum class Format { cues };
    Format format = Format::cues;
    int version = kVersion;
    std::string scene;  ///< name of the scene's file; empty: any
    std::shared_ptr<const nlohmann::json> cues;
};

/// Each cue as it is, or what is wrong with its members: types, ranges and names. What needs the scene is the
/// caller's.
using ReadCues = std::map<std::string, tl::expected<CueState, Error>>;
struct ReadCueList {
    std::string scene;
    ReadCues cues;
};

/// Or what is wrong with the list as a whole. What a cue does not give is that of `shown`.
tl::expected<ReadCueList, Error> read_cue_list(const nlohmann::json& list, const State& shown);
tl::expected<ReadCueList, Error> parse_cue_list(std::string_view text, const State& shown);

/// The patch that adds the cues of a list.
tl::expected<Patch, Error> parse_cue_patch(std::string_view text);

/// Names by `order`, then those without one, by name.
std::vector<std::string> names_in_order(const SharedMap<CueState>& cues);

}  // namespace vrut::protocol
