# The client as it is installed for other projects: a library of one object, with Asio and Beast in it. Nothing but the
# client's own symbols can be seen from outside, so that a host may use any Boost itself, built in any way. GCC's unique
# symbols could not be hidden; neither library has any (-fno-gnu-unique).
set(library ${CMAKE_CURRENT_BINARY_DIR}/package/libvrut_client.a)
set(object ${CMAKE_CURRENT_BINARY_DIR}/package/vrut_client.o)
file(MAKE_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/package)
add_custom_command(OUTPUT ${library}
    # The groups of inline functions are resolved here, or the host's linker would take those of another Boost for ours.
    COMMAND ${CMAKE_LINKER} -r --force-group-allocation --whole-archive $<TARGET_FILE:vrut_client> $<TARGET_FILE:vrut_beast> -o ${object}
    COMMAND ${CMAKE_OBJCOPY} --wildcard --keep-global-symbol=_ZN4vrut6client* --keep-global-symbol=_ZNK4vrut6client*
            --strip-unneeded ${object}
    COMMAND ${CMAKE_COMMAND} -E rm -f ${library}
    COMMAND ${CMAKE_AR} qcsD ${library} ${object}
    DEPENDS vrut_client vrut_beast COMMENT "The client's library for other projects" VERBATIM)
add_custom_target(client_package ALL DEPENDS ${library})

# Found by CMake's find_package(vrut_client) and by pkg-config, both from where their files lie: the folder may be moved.
include(CMakePackageConfigHelpers)
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/vrut_client-config.cmake
"include(CMakeFindDependencyMacro)
find_dependency(OpenSSL)
find_dependency(Threads)
if(NOT TARGET vrut_client::vrut_client)
    get_filename_component(prefix \${CMAKE_CURRENT_LIST_DIR}/../../.. ABSOLUTE)
    add_library(vrut_client::vrut_client STATIC IMPORTED)
    set_target_properties(vrut_client::vrut_client PROPERTIES IMPORTED_LOCATION \${prefix}/lib/libvrut_client.a
        INTERFACE_INCLUDE_DIRECTORIES \${prefix}/include/vrut_client INTERFACE_LINK_LIBRARIES \"OpenSSL::SSL;Threads::Threads\")
endif()
")
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/vrut_client-config-version.cmake
    VERSION ${CMAKE_PROJECT_VERSION} COMPATIBILITY SameMinorVersion)
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/vrut_client.pc
"prefix=\${pcfiledir}/../..
Name: vrut_client
Description: C++ client of VRUT Preview for hosts
Version: ${CMAKE_PROJECT_VERSION}
Cflags: -I\${prefix}/include/vrut_client
Libs: -L\${prefix}/lib -lvrut_client -lssl -lcrypto -pthread
")

set(client COMPONENT client EXCLUDE_FROM_ALL)
install(FILES ${library} DESTINATION lib ${client})
install(FILES preview_client.hpp DESTINATION include/vrut_client ${client})
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/vrut_client-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/vrut_client-config-version.cmake
    DESTINATION lib/cmake/vrut_client ${client})
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/vrut_client.pc DESTINATION lib/pkgconfig ${client})
install(FILES README.md example_host.cpp DESTINATION share/doc/libvrut-client-dev ${client})
