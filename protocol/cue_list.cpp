#include "cue_list.hpp"

#include <algorithm>
#include <limits>

#include "file_descriptions.hpp"

namespace vrut::protocol {

namespace {

tl::expected<CueState, Error> read_cue(const std::string& name, const Json& cue, const State& shown) {
    const auto next = patched(shown, shown, {{"cues", {{name, cue}}}});
    if (!next) return tl::unexpected(next.error());
    const auto read = next->cues->find(name);
    if (read != next->cues->end()) return read->second;
    return tl::unexpected(
        Error{{}, error_code::bad_message, "'cues." + excerpt(name) + "' must be an object"});
}

ReadCueList read_or_throw(const Json& json, State shown) {
    // Of a newer list the rest may be anything.
    const auto version = read_object(json, "the list").find("version");
    if (version != json.end() && version->is_number_integer() && *version > CueList::kVersion)
        throw BadJson{error_code::out_of_range,
                      "the list is of version " + version->dump() + ", and this program reads version " +
                          std::to_string(CueList::kVersion) + ": use a newer program"};
    const CueList list = read_struct<CueList>(json, "");
    if (list.cues->size() > kMaxCues)
        throw BadJson{error_code::too_many, "'cues' holds " + std::to_string(kMaxCues) + " entries at most"};
    shown.cues = {};
    ReadCueList read{list.scene, {}};
    for (const auto& [name, cue] : list.cues->items()) read.cues.emplace(name, read_cue(name, cue, shown));
    return read;
}

}  // namespace

tl::expected<ReadCueList, Error> read_cue_list(const Json& list, const State& shown) {
    return or_error([&] { return read_or_throw(list, shown); });
}

tl::expected<ReadCueList, Error> parse_cue_list(std::string_view text, const State& shown) {
    return or_error([&] { return read_or_throw(parse_strictly(text), shown); });
}

tl::expected<Patch, Error> parse_cue_patch(std::string_view text) {
    return or_error([&] {
        const CueList list = read_struct<CueList>(parse_strictly(text), "");
        return Patch{std::make_shared<const Json>(Json{{"cues", *list.cues}}), {}};
    });
}

std::vector<std::string> names_in_order(const SharedMap<CueState>& cues) {
    std::vector<std::string> names;
    names.reserve(cues->size());
    for (const auto& [name, cue] : *cues) names.push_back(name);
    std::ranges::stable_sort(names, {}, [&](const std::string& name) {
        return cues->at(name).order.value_or(std::numeric_limits<double>::infinity());
    });
    return names;
}

}  // namespace vrut::protocol
