#include "metrics.hpp"

namespace vrut {

std::string Metrics::text() const {
    std::string out;
    const auto add = [&](const char* name, const char* help, std::uint64_t value,
                         const char* type = "counter") {
        out += std::string("# HELP vrut_preview_") + name + " " + help + "\n# TYPE vrut_preview_" + name +
               " " + type + "\nvrut_preview_" + name + " " + std::to_string(value) + "\n";
    };
    add("clients", "Clients connected now.", clients_joined - clients_left, "gauge");
    add("messages_received_total", "Messages that clients sent.", messages_received);
    add("messages_refused_total", "Messages answered by an error.", messages_refused);
    add("frames_granted_total", "Frames that clients asked for.", frames_granted);
    add("frames_rendered_moving_total", "Pictures drawn while things moved.", frames_rendered_moving);
    add("frames_rendered_still_total", "Pictures drawn at rest.", frames_rendered_still);
    add("frames_interrupted_total", "Pictures given up because what was to be seen had changed.",
        frames_interrupted);
    add("samples_drawn_total", "Samples drawn, for pictures of any kind.", samples_drawn);
    add("readbacks_total", "Times that pixels were read back from what draws.", readbacks);
    add("frames_encoded_total", "Pictures encoded.", frames_encoded);
    add("bytes_encoded_total", "Bytes of encoded pictures.", bytes_encoded);
    add("frames_sent_total", "Frames handed to sockets.", frames_sent);
    add("frames_replaced_total", "Frames that gave way to newer ones before they were sent.",
        frames_replaced);
    add("pictures_held", "Encoded pictures in memory.", pictures_held, "gauge");
    add("pictures_held_most", "The most encoded pictures that were ever in memory.", pictures_held_most,
        "gauge");
    add("snapshots_rendered_total", "Snapshots drawn.", snapshots_rendered);
    add("snapshots_sent_total", "Snapshots handed to sockets.", snapshots_sent);
    add("bytes_sent_total", "Bytes of messages handed to sockets.", bytes_sent);
    return out;
}

}  // namespace vrut
