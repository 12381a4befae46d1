# What is installed: headers, library, program, manual page, the environment map and the sky tables with their licences,
# and what CMake and pkg-config need to find the library. Never the dragon: its terms are not ours to pass on in a
# package.

include(CMakePackageConfigHelpers)

install(TARGETS heliostat EXPORT heliostatTargets)
install(FILES assets/sunrise.hdr assets/LICENSE-CC0.txt DESTINATION ${CMAKE_INSTALL_DATADIR}/heliostat)
# The tables are in the library; their licence wants to be passed on with it.
install(DIRECTORY assets/sky DESTINATION ${CMAKE_INSTALL_DATADIR}/heliostat)
if(HELIO_WITH_VULKAN)
    install(DIRECTORY shaders/ DESTINATION ${CMAKE_INSTALL_DATADIR}/heliostat/shaders FILES_MATCHING PATTERN "*.glsl"
            PATTERN "layout.h")
    install(FILES src/sampling/rules.h DESTINATION ${CMAKE_INSTALL_DATADIR}/heliostat/shaders/sampling)
else()
    set(WITHOUT_VULKAN PATTERN "vulkan.h" EXCLUDE) # it needs a header that may not be there
endif()
install(DIRECTORY include/heliostat TYPE INCLUDE FILES_MATCHING PATTERN "*.h" ${WITHOUT_VULKAN})
install(FILES LICENSE TYPE DOC)
if(TARGET heliostat_program)
    install(TARGETS heliostat_program)
    set_target_properties(heliostat_program PROPERTIES INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")
    if(EXISTS "${CMAKE_CURRENT_SOURCE_DIR}/docs/heliostat.1")
        install(FILES docs/heliostat.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
    endif()
endif()

# A static library hands what it needs on to its users; a shared one keeps it to itself.
set(CONFIG_PACKAGES "")
set(PC_REQUIRES "")
set(PC_LIBRARIES "")
if(NOT BUILD_SHARED_LIBS)
    set(CONFIG_PACKAGES "find_dependency(Threads)\n")
    set(PC_LIBRARIES "-lm -pthread")
    if(HELIO_WITH_OPENEXR)
        string(APPEND CONFIG_PACKAGES "find_dependency(OpenEXR CONFIG)\n")
        list(APPEND PC_REQUIRES OpenEXR)
    endif()
    if(HELIO_WITH_PNG)
        string(APPEND CONFIG_PACKAGES "find_dependency(PNG)\n")
        list(APPEND PC_REQUIRES libpng)
    endif()
    if(HELIO_WITH_JPEG)
        string(APPEND CONFIG_PACKAGES "find_dependency(JPEG)\n")
        list(APPEND PC_REQUIRES libjpeg)
    endif()
    if(HELIO_WITH_ASSIMP)
        string(APPEND CONFIG_PACKAGES "find_dependency(assimp CONFIG)\nfind_dependency(ZLIB)\n")
        list(APPEND PC_REQUIRES assimp zlib)
    endif()
    if(HELIO_WITH_FFMPEG)
        string(APPEND CONFIG_PACKAGES "find_dependency(PkgConfig)\n"
               "pkg_check_modules(FFMPEG REQUIRED QUIET IMPORTED_TARGET "
               "libavformat libavcodec libavutil)\n")
        list(APPEND PC_REQUIRES libavformat libavcodec libavutil)
    endif()
    if(HELIO_WITH_LCMS2)
        string(APPEND CONFIG_PACKAGES "find_dependency(PkgConfig)\n"
               "pkg_check_modules(LCMS2 REQUIRED QUIET IMPORTED_TARGET lcms2)\n")
        list(APPEND PC_REQUIRES lcms2)
    endif()
    if(HELIO_WITH_EMBREE)
        string(APPEND CONFIG_PACKAGES "find_dependency(embree ${EMBREE_MAJOR} CONFIG)\n")
        string(PREPEND PC_LIBRARIES "-lembree${EMBREE_MAJOR} ") # Embree brings no pkg-config file
    endif()
endif()
list(JOIN PC_REQUIRES " " PC_REQUIRES)

set(PACKAGE_DIRECTORY "${CMAKE_INSTALL_LIBDIR}/cmake/heliostat")
install(EXPORT heliostatTargets NAMESPACE heliostat:: DESTINATION "${PACKAGE_DIRECTORY}")
configure_package_config_file(cmake/heliostatConfig.cmake.in heliostatConfig.cmake
                              INSTALL_DESTINATION "${PACKAGE_DIRECTORY}")
# Before 1.0 every minor version may change the interface.
write_basic_package_version_file(heliostatConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES "${CMAKE_CURRENT_BINARY_DIR}/heliostatConfig.cmake"
              "${CMAKE_CURRENT_BINARY_DIR}/heliostatConfigVersion.cmake" DESTINATION "${PACKAGE_DIRECTORY}")
# Relative to the file itself, so that what was installed can be moved.
file(RELATIVE_PATH PC_PREFIX "${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig" "${CMAKE_INSTALL_PREFIX}")
configure_file(cmake/heliostat.pc.in heliostat.pc @ONLY)
install(FILES "${CMAKE_CURRENT_BINARY_DIR}/heliostat.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
