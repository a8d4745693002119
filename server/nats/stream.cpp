#include "nats/stream.hpp"

namespace vrut::server::nats {

bool has_refused(natsStatus status) {
    return status != NATS_OK && status != NATS_TIMEOUT && status != NATS_NO_RESPONDERS;
}

void add_stream(const Connection& connection, const Stream& stream) {
    jsErrCode error{};
    natsStatus status = NATS_OK;
    for (const int replicas : kReplicas) {
        std::array<const char*, 1> subjects{stream.subject.c_str()};
        jsStreamConfig config;
        jsStreamConfig_Init(&config);
        config.Name = stream.name.c_str();
        config.Subjects = subjects.data();
        config.SubjectsLen = 1;
        config.Retention = stream.retention;
        config.MaxAge = stream.kept.count();
        config.Replicas = replicas;
        status = js_AddStream(nullptr, connection.jetstream(), &config, nullptr, &error);
        // It is there, with another number of replicas.
        if (status == NATS_OK || error == JSStreamNameExistErr) return;
        if (!has_refused(status)) break;
    }
    connection.require(status, "the stream " + stream.name + " cannot be made", error);
}

}  // namespace vrut::server::nats
