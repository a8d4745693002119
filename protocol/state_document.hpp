#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "state.hpp"

namespace vrut::protocol {

/// One revision of the state as JSON, to be shared between threads. Sections that did not change are the same
/// objects in both documents, which makes making and comparing documents cheap.
class StateDocument {
public:
    StateDocument() = default;
    /// The document after `previous`, one revision later; the same object contents where nothing changed.
    static std::shared_ptr<const StateDocument> next(const StateDocument& previous, const State& state);
    /// The same, with a later revision than the next.
    static std::shared_ptr<const StateDocument> next(const StateDocument& previous, const State& state,
                                                     std::int64_t revision);

    /// The document that a message of encode() or encode_patch_from() leads to; that of a patch must lead
    /// from `known`, which may be null for a whole one. Or a sentence that tells what is wrong with the text.
    /// shows() is false for any state, and last_change() is its own revision.
    static tl::expected<std::shared_ptr<const StateDocument>, std::string> received(
        std::string_view text, const StateDocument* known);

    /// What hosts get: the same revision, with the camera of `walls` as `camera`, which stands at no node
    /// then. Null where they get this one. Its shows() is false for any state.
    std::shared_ptr<const StateDocument> for_hosts() const;

    std::int64_t revision() const { return revision_; }
    bool shows(const State& state) const { return state_ == state; }
    /// The `state` message.
    std::string encode() const;
    /// The document alone.
    nlohmann::json json() const;
    /// A member of the document; null where there is none.
    const nlohmann::json& section(std::string_view name) const;
    /// Who holds control; none: nobody.
    std::optional<std::string> holder() const;
    /// The `patch` message that leads from an earlier document to this one; `by` may be empty.
    std::string encode_patch_from(const StateDocument& earlier, const std::string& by) const;
    /// Of the same scene: else the difference may be as large as the document, and that is sent.
    bool has_scene_of(const StateDocument& other) const;
    /// Revision of the last change to anything that `patch` names.
    std::int64_t last_change(const nlohmann::json& patch) const;

private:
    struct Section;
    std::int64_t revision_ = 0;
    State state_;
    std::vector<std::shared_ptr<const Section>> sections_;
};

}  // namespace vrut::protocol
