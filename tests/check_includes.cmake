# Fails where a folder includes a library that is none of its business. Libraries of headers alone would compile
# anywhere; the project's own are kept apart by what each CMake target links.
function(check_text folder pattern why)
    file(GLOB_RECURSE files ${SOURCE}/${folder}/*.cpp ${SOURCE}/${folder}/*.hpp)
    list(FILTER files EXCLUDE REGEX "/protocol/client/")  # for other programs; nothing of ours links it
    foreach(file IN LISTS files)
        file(STRINGS ${file} lines REGEX "${pattern}")
        if(lines)
            message(SEND_ERROR "${file}: ${lines}: ${why}")
        endif()
    endforeach()
endfunction()

function(check folder pattern why)
    check_text(${folder} "^#include [<\"](${pattern})" "${why}")
endfunction()

check(protocol "boost/|GL/|EGL/|spdlog/|turbojpeg|png" "protocol/ knows JSON, and no GL and no sockets")
check(render "boost/|nlohmann/|spdlog/|sys/socket|netinet/" "nothing under render/ knows sockets or JSON")
foreach(room base math scene mesh io navigation plan reference compare renderer)
    check(render/${room} "GL/|EGL/|gl/gl\\.hpp" "GL is for render/gl")
endforeach()
check(render/navigation "ctime|sys/time" "navigation is pure: no clock")
check_text(render/navigation "_clock|[^a-z_]time\\(NULL|[^a-z_]time\\(nullptr|random" "navigation is pure: what time it is comes with the input")
check(server "GL/|EGL/|gl/|nlohmann/" "GL is for render/, JSON for protocol/")
check(server/room "thread>|mutex>|fstream>|filesystem>|boost/|spdlog/|turbojpeg" "the room is a state machine: no threads, no files, no sockets")
check_text(server/room "_clock|Clock::now|[^a-z_]time\\(NULL|[^a-z_]time\\(nullptr" "the room is a state machine: what time it is comes with the message")
check_text(server "spdlog::(debug|info|warn|error|critical)[(]" "a line of the log is written by log.hpp, where no text can forge one")
