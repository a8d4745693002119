#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "state.hpp"
#include "state_document.hpp"

namespace vrut::server::room {

/// The revisions of the state, and who made them.
class Revisions {
public:
    /// What changes from here on is this client's doing; empty: the server's, or nobody's.
    void begin(const std::string& changing) { changing_ = changing; }
    const std::string& changing() const { return changing_; }
    /// The document of `state`, as a new revision where it differs from the newest.
    const std::shared_ptr<const protocol::StateDocument>& of(const protocol::State& state) {
        if (newest_->shows(state)) return newest_;
        newest_ = protocol::StateDocument::next(*newest_, state);
        if (changed_by_ != changing_ || changed_by_since_ == 0) changed_by_since_ = newest_->revision();
        changed_by_ = changing_;
        return newest_;
    }
    /// As of() has it, but as this revision, which another server has given it. `first`: there is none before
    /// it.
    void go_to(std::int64_t revision, const protocol::State& state, bool first = false) {
        newest_ =
            protocol::StateDocument::next(first ? protocol::StateDocument{} : *newest_, state, revision);
    }
    const protocol::StateDocument& newest() const { return *newest_; }
    /// Who made the newest revision and those before it, down to changed_by_since(); empty: the server.
    const std::string& changed_by() const { return changed_by_; }
    std::int64_t changed_by_since() const { return changed_by_since_; }

private:
    std::shared_ptr<const protocol::StateDocument> newest_ =
        std::make_shared<const protocol::StateDocument>();
    std::string changed_by_, changing_;
    std::int64_t changed_by_since_ = 0;
};

}  // namespace vrut::server::room
