#include "room/steering.hpp"

#include <algorithm>

namespace vrut::server::room {

void Steering::join(const std::string& client, const std::string& resume_key) {
    const bool resumes = holder_ && !resume_key.empty() && resume_key == resume_key_;
    // The holder whose place it takes is the same page before it lost its connection.
    if (resumes && !is_absent()) candidates_.push_back({*holder_, {}});
    if (!resumes && holder_) return candidates_.push_back({client, resume_key});
    holder_ = client;
    resume_key_ = resume_key;
    absent_since_.reset();
}

void Steering::leave(const std::string& client, SessionTime now, bool keeps_control) {
    decline(client);
    std::erase_if(candidates_, [&](const Candidate& candidate) { return candidate.client == client; });
    if (!holds(client)) return;
    if (resume_key_.empty() && !keeps_control) return pass_on();
    absent_since_ = now;
}

void Steering::advance(SessionTime now) {
    if (absent_since_ && now - *absent_since_ >= kAbsence) pass_on();
}

std::optional<SessionTime> Steering::deadline() const {
    if (!absent_since_) return std::nullopt;
    return *absent_since_ + kAbsence;
}

void Steering::take(const std::string& client) {
    decline(client);
    if (holds(client)) return absent_since_.reset();
    const auto found = std::ranges::find(candidates_, client, &Candidate::client);
    Candidate taking{client, {}};
    if (found != candidates_.end()) {
        taking = *found;
        candidates_.erase(found);
    }
    if (holder_ && !is_absent()) candidates_.insert(candidates_.begin(), {*holder_, resume_key_});
    holder_ = taking.client;
    resume_key_ = taking.resume_key;
    absent_since_.reset();
}

void Steering::release() {
    if (!asking_.empty())
        take(std::string(asking_.front()));
    else if (!candidates_.empty())
        take(std::string(candidates_.front().client));
}

void Steering::ask(const std::string& client) {
    if (!holds(client) && std::ranges::find(asking_, client) == asking_.end()) asking_.push_back(client);
}

void Steering::decline(const std::string& client) { std::erase(asking_, client); }

std::vector<std::string> Steering::candidates() const {
    std::vector<std::string> clients;
    clients.reserve(candidates_.size());
    for (const Candidate& candidate : candidates_) clients.push_back(candidate.client);
    return clients;
}

bool Steering::is_here(const std::string& client) const {
    return (holds(client) && !is_absent()) ||
           std::ranges::find(candidates_, client, &Candidate::client) != candidates_.end();
}

void Steering::clear_holder() {
    holder_.reset();
    resume_key_.clear();
    absent_since_.reset();
}

void Steering::pass_on() {
    clear_holder();
    release();
}

}  // namespace vrut::server::room
