#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "observe/metrics.hpp"
#include "state.hpp"
#include "state_document.hpp"

namespace vrut::server::net {

/// A message on its way to clients.
using Text = std::shared_ptr<const std::string>;
/// Counts as held (Metrics::bytes_held) as long as anybody has it.
Text held_text(std::string text, observe::Metrics& metrics);

/// The newest document of the state, and the messages that bring clients to it. Each is encoded once for all
/// clients that have the same revision.
class DocumentUpdates {
public:
    /// `by` made it and the revisions before it, down to `by_since`; empty: the server.
    void set(std::shared_ptr<const protocol::StateDocument> document, std::string by, std::int64_t by_since);
    /// Null before the first.
    const std::shared_ptr<const protocol::StateDocument>& newest() const { return newest_; }
    /// `state` or `patch` for a client that has `known`; null: none. There must be a newest.
    Text update_from(const protocol::StateDocument* known, observe::Metrics& metrics);

private:
    std::string encode_from(const protocol::StateDocument* known) const;

    std::shared_ptr<const protocol::StateDocument> newest_;
    std::string by_;
    std::int64_t by_since_ = 0;
    std::map<std::int64_t, std::weak_ptr<const std::string>> updates_;  // by the revision that is known
    std::map<std::int64_t, Text> small_updates_;  // kept, though nobody is being sent them
};

}  // namespace vrut::server::net
