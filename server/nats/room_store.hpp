#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "nats/connection.hpp"

namespace vrut::server::nats {

/// What servers of one room keep at NATS: who draws it, its state, and the log of what happened since.
class RoomStore {
public:
    /// Makes what is not there. Throws std::runtime_error where it cannot be made.
    RoomStore(const Connection& connection, std::string room);

    // --- who draws the room: a key that expires
    static constexpr std::chrono::seconds kLease{2};
    /// False: another server has it, or NATS does not answer.
    bool take_lease(const std::string& holder);
    enum class Renewed { yes, expired, lost, unknown };  ///< lost: to another server
    Renewed renew_lease();
    void release_lease();

    // --- its state at one point of the log
    struct State {
        std::uint64_t sequence = 0;  ///< of the last entry of the log that led there
        std::string text;
    };
    /// None where none is kept. Throws std::runtime_error where NATS does not answer.
    std::optional<State> state() const;
    /// And forgets the log before that entry. Returns false where it could not be stored, or a later one is
    /// there.
    bool store_state(const State& state);
    /// How long a state is kept that is not stored again. What is older is forgotten.
    std::chrono::nanoseconds state_kept() const { return state_kept_; }

    // --- the log
    struct Entry {
        std::uint64_t sequence = 0;
        std::string text;
    };
    /// Follows the log from behind `sequence` on.
    void follow(std::uint64_t sequence);
    /// Entries that were not read yet are there no longer: a later state made them needless.
    struct EntriesForgotten : std::runtime_error {
        using std::runtime_error::runtime_error;
    };
    /// The next ones, none within `patience`. Throws EntriesForgotten.
    std::vector<Entry> next(std::chrono::milliseconds patience);
    /// Sequences of the first entry and of the last. An empty log's last is the one before its first.
    struct Range {
        std::uint64_t first = 0, last = 0;
    };
    /// What the log has; none where NATS does not answer.
    std::optional<Range> range() const;
    /// Whether a server may begin the room without a state, behind this log: nothing was done in the room, or
    /// for so long that NATS has forgotten its state. Throws std::runtime_error where NATS does not answer.
    bool may_begin(const Range& log);
    enum class NotAppended { superseded, unknown };  ///< superseded: another entry is there
    /// Adds an entry behind the one of `last`, and only there. An entry of this `id` is added once, however
    /// often it is tried. Returns its sequence.
    tl::expected<std::uint64_t, NotAppended> append(const std::string& text, std::uint64_t last,
                                                    const std::string& id);

private:
    using KeyValue = Handle<kvStore, kvStore_Destroy>;
    using JetStream = Handle<jsCtx, jsCtx_Destroy>;
    KeyValue bucket(const char* name, std::int64_t time_to_live) const;
    struct Kept {
        State state;
        std::uint64_t revision = 0;  ///< of the key
    };
    std::optional<Kept> kept_state() const;
    Message entry_at(std::uint64_t sequence) const;
    bool was_untouched(const Range& log) const;

    const Connection& connection_;
    const std::string room_, log_, subject_;
    const JetStream impatient_;  ///< a server that draws does not wait for long
    KeyValue leases_, states_;
    std::chrono::nanoseconds state_kept_;
    std::string holder_;
    std::uint64_t lease_revision_ = 0;  ///< of the key, as this server renewed it last
    std::uint64_t state_revision_ = 0;  ///< of the key, as this server knows it; 0: it has none
    std::uint64_t followed_ = 0;        ///< sequence of the last entry that came
    Subscription subscription_;
};

}  // namespace vrut::server::nats
