#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "event_log.hpp"
#include "room/recording.hpp"
#include "room/steering.hpp"
#include "state.hpp"

namespace vrut::server::room {

/// A message that is answered later.
struct AnsweredLater {
    std::string client;
    protocol::ClientMessage message;
};

/// Messages whose answers take a disk, by numbers.
class AnswersLater {
public:
    std::int64_t add(AnsweredLater asked) {
        asked_[++newest_] = std::move(asked);
        return newest_;
    }
    /// Once for each number; none: there is none of it.
    std::optional<AnsweredLater> take(std::int64_t number) {
        auto found = asked_.extract(number);
        return found.empty() ? std::nullopt : std::optional(std::move(found.mapped()));
    }
    bool empty() const { return asked_.empty(); }

private:
    std::int64_t newest_ = 0;
    std::map<std::int64_t, AnsweredLater> asked_;
};

/// A log that is being written.
struct Recording {
    protocol::LogTime since{0};  ///< when it began
    std::string name = {};       ///< empty: it is not open yet
    AnsweredLater start;
    std::optional<AnsweredLater> stop = {};  ///< no more lines come
};

/// The recordings of a room, until all of them is written. One at a time takes lines.
class Recordings {
public:
    /// None: nothing is recorded.
    explicit Recordings(std::optional<RecordingSink> sink) : sink_(std::move(sink)) {}

    bool has_sink() const { return sink_.has_value(); }
    bool empty() const { return recordings_.empty(); }
    /// The one that takes lines; null: none does.
    const Recording* active() const;
    /// From here on there are lines, whenever its file is open.
    void begin(const std::string& name, RecordingSink::Header header, SessionTime now, AnsweredLater start);
    void write(SessionTime now, const std::string& client, decltype(protocol::LogLine::what) what);
    /// The active one takes no more lines.
    void end(AnsweredLater stop);
    /// Null where there is none of this number.
    Recording* find(std::int64_t recording);
    /// None likewise.
    std::optional<Recording> take(std::int64_t recording);

private:
    std::optional<RecordingSink> sink_;
    std::int64_t newest_ = 0;
    std::map<std::int64_t, Recording> recordings_;
};

/// The log of all that happens in a room, which another server follows.
class Journal {
public:
    using Write = std::function<void(protocol::LogLine line)>;
    /// Empty: nobody follows.
    explicit Journal(Write write) : write_(std::move(write)) {}
    /// It goes on at another place.
    void use(Write write) { write_ = std::move(write); }

    void write(SessionTime now, const std::string& client, decltype(protocol::LogLine::what) what) const {
        if (write_) write_({now, client, std::move(what)});
    }
    /// A line that names this revision of the state, where none has yet.
    void write_revision(SessionTime now, std::int64_t revision, const protocol::State& state);

private:
    Write write_;
    protocol::LogLine::Revised newest_;  ///< as the journal has it
};

}  // namespace vrut::server::room
