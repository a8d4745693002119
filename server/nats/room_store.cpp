#include "nats/room_store.hpp"

#include <zlib.h>

#include <algorithm>
#include <stdexcept>
#include <string_view>

#include "nats/stream.hpp"
#include "observe/log.hpp"

namespace vrut::server::nats {

namespace {

using namespace std::chrono_literals;

constexpr const char *kLeases = "VRUT_LEASES", *kStates = "VRUT_ROOMS";
/// A room that nobody has drawn for so long is forgotten.
constexpr std::int64_t kStateKept = std::chrono::nanoseconds(10min).count();
constexpr const char* kId = "Nats-Msg-Id";
constexpr std::chrono::milliseconds kStorePatience{400};
constexpr std::size_t kMostEntries = 256;

std::string upper(std::string text) {
    std::ranges::transform(text, text.begin(), [](char c) {
        return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    });
    return text;
}

/// As its size, a line, and what zlib makes of it.
std::string deflated(const std::string& text) {
    uLongf size = compressBound(text.size());
    std::string bytes(size, 0);
    if (compress2(reinterpret_cast<Bytef*>(bytes.data()), &size, reinterpret_cast<const Bytef*>(text.data()),
                  text.size(), Z_BEST_SPEED) != Z_OK)
        return {};
    bytes.resize(size);
    return std::to_string(text.size()) + "\n" + bytes;
}

/// None where it is not what deflated() gives.
std::optional<std::string> inflated(std::string_view bytes) {
    constexpr std::size_t kLargest = std::size_t{256} << 20;
    const std::size_t line = std::min(bytes.find('\n'), bytes.size());
    const auto expected = number_of(std::string(bytes.substr(0, line)));
    if (!expected || *expected > kLargest || line == bytes.size()) return {};
    std::string text(*expected, 0);
    uLongf size = text.size();
    bytes.remove_prefix(line + 1);
    if (uncompress(reinterpret_cast<Bytef*>(text.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                   bytes.size()) != Z_OK)
        return {};
    text.resize(size);
    return text;
}

/// A context of JetStream whose calls return within kStorePatience.
jsCtx* impatient(natsConnection* connection) {
    jsOptions options;
    jsOptions_Init(&options);
    options.Wait = kStorePatience.count();
    jsCtx* context = nullptr;
    natsConnection_JetStream(&context, connection, &options);
    return context;
}

/// How long a bucket keeps its values.
std::chrono::nanoseconds time_to_live(const Connection& connection, kvStore* bucket) {
    kvStatus* found = nullptr;
    connection.require(kvStore_Status(&found, bucket), "the bucket of states cannot be read");
    const Handle<kvStatus, kvStatus_Destroy> status(found);
    const std::chrono::nanoseconds kept(kvStatus_TTL(found));
    return kept > 0ns ? kept : std::chrono::nanoseconds::max();
}

}  // namespace

RoomStore::RoomStore(const Connection& connection, std::string room)
    : connection_(connection),
      room_(std::move(room)),
      log_("VRUT_LOG_" + upper(room_)),
      subject_("vrut.rooms." + room_ + ".log"),
      impatient_(impatient(connection.get())),
      leases_(bucket(kLeases, std::chrono::nanoseconds(kLease).count())),
      states_(bucket(kStates, kStateKept)),
      state_kept_(time_to_live(connection, states_.get())) {
    add_stream(connection, {log_, subject_});
}

RoomStore::KeyValue RoomStore::bucket(const char* name, std::int64_t time_to_live) const {
    kvStore* store = nullptr;
    if (js_KeyValue(&store, impatient_.get(), name) == NATS_OK) return KeyValue(store);
    natsStatus status = NATS_OK;
    for (const int replicas : kReplicas) {
        kvConfig config;
        kvConfig_Init(&config);
        config.Bucket = name;
        config.TTL = time_to_live;
        config.History = 1;
        config.Replicas = replicas;
        status = js_CreateKeyValue(&store, connection_.jetstream(), &config);
        kvStore_Destroy(store);
        if (status == NATS_OK && js_KeyValue(&store, impatient_.get(), name) == NATS_OK)
            return KeyValue(store);
        if (!has_refused(status)) break;
    }
    connection_.require(status, "the bucket " + std::string(name) + " cannot be made");
    return {};
}

// --- who draws the room

bool RoomStore::take_lease(const std::string& holder) {
    std::uint64_t revision = 0;
    if (kvStore_CreateString(&revision, leases_.get(), room_.c_str(), holder.c_str()) != NATS_OK)
        return false;
    holder_ = holder;
    lease_revision_ = revision;
    return true;
}

RoomStore::Renewed RoomStore::renew_lease() {
    std::uint64_t revision = 0;
    const natsStatus status =
        kvStore_UpdateString(&revision, leases_.get(), room_.c_str(), holder_.c_str(), lease_revision_);
    if (status == NATS_OK) {
        lease_revision_ = revision;
        return Renewed::yes;
    }
    if (!connection_.is_connected()) return Renewed::unknown;
    // With another answer or none, the key itself shows who has it.
    kvEntry* found = nullptr;
    const natsStatus read = kvStore_Get(&found, leases_.get(), room_.c_str());
    const Handle<kvEntry, kvEntry_Destroy> entry(found);
    if (read == NATS_NOT_FOUND) return Renewed::expired;
    if (read != NATS_OK) return Renewed::unknown;
    const bool is_own = kvEntry_ValueString(found) == holder_;
    if (is_own) lease_revision_ = kvEntry_Revision(found);  // an answer was lost
    return is_own ? Renewed::yes : Renewed::lost;
}

void RoomStore::release_lease() { kvStore_Delete(leases_.get(), room_.c_str()); }

// --- its state

std::optional<RoomStore::State> RoomStore::state() const {
    auto kept = kept_state();
    if (!kept) return std::nullopt;
    return std::move(kept->state);
}

std::optional<RoomStore::Kept> RoomStore::kept_state() const {
    kvEntry* found = nullptr;
    const natsStatus status = kvStore_Get(&found, states_.get(), room_.c_str());
    const Handle<kvEntry, kvEntry_Destroy> entry(found);
    if (status == NATS_NOT_FOUND) return std::nullopt;
    connection_.require(status, "the state of the room cannot be read");
    const std::string_view value(static_cast<const char*>(kvEntry_Value(found)),
                                 static_cast<std::size_t>(kvEntry_ValueLen(found)));
    const std::size_t line = std::min(value.find('\n'), value.size());
    const auto sequence = number_of(std::string(value.substr(0, line)));
    auto text = sequence && line < value.size() ? inflated(value.substr(line + 1)) : std::nullopt;
    if (!text)
        throw std::runtime_error("the state of the room '" + room_ +
                                 "' cannot be read: serve it by another name, or wait for ten minutes, when "
                                 "NATS has forgotten it");
    return Kept{{*sequence, *std::move(text)}, kvEntry_Revision(found)};
}

/// In place of the state that this server knows, and of no other: what a former owner of the room, or a NATS
/// server that hung, still has to say does not undo it.
bool RoomStore::store_state(const State& state) {
    const std::string value = std::to_string(state.sequence) + "\n" + deflated(state.text);
    const auto put = [&] {
        const int size = static_cast<int>(value.size());
        return state_revision_ == 0
                   ? kvStore_Create(&state_revision_, states_.get(), room_.c_str(), value.data(), size)
                   : kvStore_Update(&state_revision_, states_.get(), room_.c_str(), value.data(), size,
                                    state_revision_);
    };
    if (put() != NATS_OK) {
        try {
            const auto kept = kept_state();
            if (kept && kept->state.sequence > state.sequence) return false;
            state_revision_ = kept ? kept->revision : 0;
        } catch (const std::runtime_error&) {
            return false;
        }
        if (put() != NATS_OK) return false;
    }
    jsOptions options;
    jsOptions_Init(&options);
    options.Stream.Purge.Sequence = state.sequence;  // that entry stays: an empty log may begin again
    js_PurgeStream(impatient_.get(), log_.c_str(), &options, nullptr);
    return true;
}

// --- the log

void RoomStore::follow(std::uint64_t sequence) {
    jsSubOptions options;
    jsSubOptions_Init(&options);
    options.Stream = log_.c_str();
    options.Ordered = true;
    options.Config.DeliverPolicy = js_DeliverByStartSequence;
    options.Config.OptStartSeq = sequence + 1;
    jsErrCode error{};
    natsSubscription* subscription = nullptr;
    const natsStatus status =
        js_SubscribeSync(&subscription, connection_.jetstream(), subject_.c_str(), nullptr, &options, &error);
    connection_.require(status, "the log of the room cannot be read", error);
    subscription_.reset(subscription);
    followed_ = sequence;
}

std::vector<RoomStore::Entry> RoomStore::next(std::chrono::milliseconds patience) {
    std::vector<Entry> entries;
    natsMsg* received = nullptr;
    while (entries.size() < kMostEntries &&
           natsSubscription_NextMsg(&received, subscription_.get(), entries.empty() ? patience.count() : 1) ==
               NATS_OK) {
        const Message message(received);
        jsMsgMetaData* meta = nullptr;
        if (natsMsg_GetMetaData(&meta, received) != NATS_OK) continue;
        const std::uint64_t sequence = meta->Sequence.Stream;
        jsMsgMetaData_Destroy(meta);
        if (sequence <= followed_) continue;
        if (sequence != followed_ + 1)
            throw EntriesForgotten("entries of the room's log are lost, from " +
                                   std::to_string(followed_ + 1));
        followed_ = sequence;
        entries.push_back({sequence, std::string(natsMsg_GetData(received),
                                                 static_cast<std::size_t>(natsMsg_GetDataLength(received)))});
    }
    return entries;
}

std::optional<RoomStore::Range> RoomStore::range() const {
    jsStreamInfo* info = nullptr;
    const natsStatus status = js_GetStreamInfo(&info, impatient_.get(), log_.c_str(), nullptr, nullptr);
    if (status != NATS_OK) return std::nullopt;
    const Range range{info->State.FirstSeq, info->State.LastSeq};
    jsStreamInfo_Destroy(info);
    return range;
}

tl::expected<std::uint64_t, RoomStore::NotAppended> RoomStore::append(const std::string& text,
                                                                      std::uint64_t last,
                                                                      const std::string& id) {
    natsMsg* created = nullptr;
    if (natsMsg_Create(&created, subject_.c_str(), nullptr, text.data(), static_cast<int>(text.size())) !=
        NATS_OK)
        return tl::unexpected(NotAppended::unknown);
    const Message message(created);
    natsMsgHeader_Set(created, "Nats-Expected-Last-Sequence", std::to_string(last).c_str());
    natsMsgHeader_Set(created, kId, id.c_str());
    jsPubOptions options;
    jsPubOptions_Init(&options);
    options.MaxWait = kStorePatience.count();
    jsErrCode error{};
    jsPubAck* acknowledged = nullptr;
    const natsStatus status = js_PublishMsg(&acknowledged, impatient_.get(), created, &options, &error);
    const Handle<jsPubAck, jsPubAck_Destroy> acknowledgement(acknowledged);
    if (status == NATS_OK) return acknowledged->Sequence;
    if (error != JSStreamWrongLastSequenceErr) return tl::unexpected(NotAppended::unknown);
    // Its acknowledgement may have been lost, longer ago than NATS remembers ids.
    const Message next = entry_at(last + 1);
    if (next && header_of(next.get(), kId) == id) return last + 1;
    return tl::unexpected(NotAppended::superseded);
}

/// Null where there is none, or NATS does not answer.
Message RoomStore::entry_at(std::uint64_t sequence) const {
    natsMsg* found = nullptr;
    js_GetMsg(&found, impatient_.get(), log_.c_str(), sequence, nullptr, nullptr);
    return Message(found);
}

/// Whether servers have taken the room over, and nothing else: their first entries are empty.
bool RoomStore::was_untouched(const Range& log) const {
    if (log.first > 1) return false;
    for (std::uint64_t sequence = 1; sequence <= log.last; ++sequence)
        if (const Message entry = entry_at(sequence); !entry || natsMsg_GetDataLength(entry.get()) > 0)
            return false;
    return true;
}

bool RoomStore::may_begin(const Range& log) {
    if (log.first > log.last || was_untouched(log)) return true;
    const Message last = entry_at(log.last);
    follow(log.last);  // from now on, by the clock that has set the entry's time
    jsConsumerInfo* info = nullptr;
    natsSubscription_GetConsumerInfo(&info, subscription_.get(), nullptr, nullptr);
    const Handle<jsConsumerInfo, jsConsumerInfo_Destroy> follower(info);
    return last && info &&
           std::chrono::nanoseconds(info->Created - natsMsg_GetTime(last.get())) >= state_kept_;
}

}  // namespace vrut::server::nats
