#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace vrut::server::room {

/// Time since the server started, or since a recording began.
using SessionTime = std::chrono::microseconds;

/// Who holds control: the first control client, until it gives control away, another takes it, or it has been
/// gone for 10 s. While a control client is here, one holds control.
class Steering {
public:
    /// So long an absent holder keeps control.
    static constexpr std::chrono::seconds kAbsence{10};
    /// A holder who has steered nothing for so long is quiet.
    static constexpr std::chrono::seconds kQuiet{1};

    /// A control client comes. It holds control if nobody does, or if the holder came with the same
    /// `resume_key`. An empty key is like no other.
    void join(const std::string& client, const std::string& resume_key);
    /// A control client comes, and who holds control is told by others.
    void arrive(const std::string& client, const std::string& resume_key) {
        candidates_.push_back({client, resume_key});
    }
    /// A client goes. A holder with a resume key, or any that `keeps_control`, is absent from then on; from
    /// others control passes on.
    void leave(const std::string& client, SessionTime now, bool keeps_control = false);
    /// From who has been absent too long control passes on.
    void advance(SessionTime now);
    /// When advance() has something to do; none: never.
    std::optional<SessionTime> deadline() const;

    /// The holder has steered something.
    void steer(SessionTime now) { last_ = now; }
    /// `client` takes control, whoever holds it.
    void take(const std::string& client);
    /// The holder gives control to who has asked first, or else to who held it last, or else to who has been
    /// here longest. Where no other control client is here, it stays.
    void release();
    /// Nobody holds control.
    void clear_holder();
    /// `client` asks the holder for control.
    void ask(const std::string& client);
    /// `client` does not ask any more, or the holder declines.
    void decline(const std::string& client);

    const std::optional<std::string>& holder() const { return holder_; }
    bool holds(const std::string& client) const { return holder_ == client; }
    bool is_absent() const { return absent_since_.has_value(); }
    /// True if nobody holds control, or the holder is absent or has been quiet for long enough.
    bool is_quiet(SessionTime now) const {
        return !holder_ || is_absent() || !last_ || now - *last_ >= kQuiet;
    }
    /// The control clients that ask for control, the first one first.
    const std::vector<std::string>& asking() const { return asking_; }
    /// The other control clients, in the order in which control would pass on to them.
    std::vector<std::string> candidates() const;
    /// True if a control client of this name is here.
    bool is_here(const std::string& client) const;

private:
    struct Candidate {
        std::string client, resume_key;
    };

    /// To the next in turn, or to nobody.
    void pass_on();

    std::optional<std::string> holder_;
    std::string resume_key_;  ///< of the holder
    std::optional<SessionTime> absent_since_;
    std::optional<SessionTime> last_;  ///< when a holder steered something
    /// The other control clients: who held control last first, then by arrival.
    std::vector<Candidate> candidates_;
    std::vector<std::string> asking_;
};

}  // namespace vrut::server::room
