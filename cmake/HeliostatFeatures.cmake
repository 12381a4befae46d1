# What the library can be built with or without. Adds to SOURCES; sets FEATURE_DEFINITIONS, FEATURE_LIBRARIES (targets)
# and EMBREE_MAJOR. The sampling core itself needs libm and threads only.

set(FEATURE_DEFINITIONS "")
set(CMAKE_THREAD_PREFER_PTHREAD ON)
set(THREADS_PREFER_PTHREAD_FLAG ON)
find_package(Threads REQUIRED)
set(FEATURE_LIBRARIES Threads::Threads m)

# Finds a package or says in one sentence which Debian package brings it and how to build without it.
# The log level: Debian's Imath, a part of OpenEXR, complains at length about a Python module that nobody asked for.
macro(heliostat_find feature debian_package)
    set(CMAKE_MESSAGE_LOG_LEVEL WARNING)
    find_package(${ARGN})
    unset(CMAKE_MESSAGE_LOG_LEVEL)
    if(NOT ${ARGV2}_FOUND)
        message(FATAL_ERROR "${ARGV2} was not found: install ${debian_package}, or build without it by "
                            "-DHELIO_WITH_${feature}=OFF.")
    endif()
endmacro()

if(HELIO_WITH_OPENEXR)
    heliostat_find(OPENEXR libopenexr-dev OpenEXR 3.1 CONFIG QUIET)
    list(APPEND SOURCES src/image/exr_channels.c src/image/exr_head.c src/image/exr_read.c src/image/exr_rgba.c
         src/image/exr_window.c src/image/exr_write.c)
    list(APPEND FEATURE_DEFINITIONS HELIO_WITH_OPENEXR=1)
    list(APPEND FEATURE_LIBRARIES OpenEXR::OpenEXRCore OpenEXR::OpenEXR)
endif()

if(HELIO_WITH_PNG)
    heliostat_find(PNG libpng-dev PNG QUIET)
    list(APPEND SOURCES src/image/png_read.c src/image/png_write.c)
    list(APPEND FEATURE_DEFINITIONS HELIO_WITH_PNG=1)
    list(APPEND FEATURE_LIBRARIES PNG::PNG)
endif()

if(HELIO_WITH_JPEG)
    heliostat_find(JPEG libjpeg-dev JPEG QUIET)
    list(APPEND SOURCES src/image/jpeg.c)
    list(APPEND FEATURE_DEFINITIONS HELIO_WITH_JPEG=1)
    list(APPEND FEATURE_LIBRARIES JPEG::JPEG)
endif()

if(HELIO_WITH_ASSIMP)
    heliostat_find(ASSIMP libassimp-dev assimp CONFIG QUIET)
    heliostat_find(ASSIMP zlib1g-dev ZLIB QUIET) # for .ply.gz
    list(APPEND SOURCES src/scene/gzip.c src/scene/mesh_arrays.c src/scene/mesh_assimp.c src/scene/mesh_child.c
         src/scene/mesh_materials.c src/scene/mesh_omissions.c src/scene/mesh_process.c src/scene/mesh_receipt.c
         src/scene/mesh_textures.c
         src/scene/ply_check.c src/scene/ply_header.c src/scene/ply_stream.c)
    list(APPEND FEATURE_DEFINITIONS HELIO_WITH_ASSIMP=1)
    list(APPEND FEATURE_LIBRARIES assimp::assimp ZLIB::ZLIB)
endif()

if(HELIO_WITH_EMBREE)
    set(EMBREE_MAJOR 4)
    find_package(embree 4 CONFIG QUIET)
    if(NOT embree_FOUND)
        set(EMBREE_MAJOR 3)
        heliostat_find(EMBREE libembree-dev embree 3 CONFIG QUIET)
    endif()
    list(APPEND SOURCES src/cpu/rays.c)
    list(APPEND FEATURE_DEFINITIONS HELIO_WITH_EMBREE=1 HELIO_EMBREE_MAJOR=${EMBREE_MAJOR})
    list(APPEND FEATURE_LIBRARIES embree)
endif()

if(HELIO_WITH_FFMPEG)
    find_package(PkgConfig REQUIRED)
    pkg_check_modules(FFMPEG QUIET IMPORTED_TARGET libavformat libavcodec libavutil)
    pkg_check_modules(AVDEVICE QUIET libavdevice) # its header alone, see video_device.h
    if(NOT FFMPEG_FOUND OR NOT AVDEVICE_FOUND)
        message(FATAL_ERROR "FFmpeg was not found: install libavformat-dev, libavcodec-dev and libavdevice-dev, or build "
                            "without it by -DHELIO_WITH_FFMPEG=OFF.")
    endif()
    list(APPEND SOURCES src/image/video_colour.c src/image/video_convert.c src/image/video_device.c src/image/video_encoder.c
         src/image/video_input.c src/image/video_log.c src/image/video_output.c src/image/video_pixels.c
         src/image/video_reader.c src/image/video_samples.c src/image/video_writer.c)
    set_source_files_properties(src/image/video_convert.c src/image/video_pixels.c src/image/video_samples.c
                                PROPERTIES COMPILE_OPTIONS "$<$<CONFIG:Release>:-O3>") # loops over pixels
    list(APPEND FEATURE_DEFINITIONS HELIO_WITH_FFMPEG=1)
    list(APPEND FEATURE_LIBRARIES PkgConfig::FFMPEG ${CMAKE_DL_LIBS})
else()
    list(APPEND SOURCES src/image/video_absent.c)
endif()

if(HELIO_WITH_LCMS2)
    find_package(PkgConfig REQUIRED)
    pkg_check_modules(LCMS2 QUIET IMPORTED_TARGET lcms2)
    if(NOT LCMS2_FOUND)
        message(FATAL_ERROR "lcms2 was not found: install liblcms2-dev, or build without it by -DHELIO_WITH_LCMS2=OFF.")
    endif()
    list(APPEND SOURCES src/eval/lab.c)
    list(APPEND FEATURE_DEFINITIONS HELIO_WITH_LCMS2=1)
    list(APPEND FEATURE_LIBRARIES PkgConfig::LCMS2)
else()
    list(APPEND SOURCES src/eval/lab_absent.c)
endif()

if(HELIO_WITH_VULKAN)
    find_package(Vulkan QUIET) # headers alone: the loader is looked for when a device is asked for
    find_program(GLSLC glslc)
    if(NOT Vulkan_INCLUDE_DIR OR NOT GLSLC)
        message(FATAL_ERROR "Vulkan was not found: install libvulkan-dev and glslc, or build without it by "
                            "-DHELIO_WITH_VULKAN=OFF.")
    endif()
    set(SHADERS faults resample resample_large rows marginals faces moments evenness pools tiles tile_light bins lobes greatest
        lists draw_lists draw_bins tile_control known control_sums shade shade_tiles background primary list_groups
        raster.vert raster.frag show sky sun)
    include(HeliostatShaders)
    list(APPEND SOURCES src/vulkan/bins.c src/vulkan/buffer.c src/vulkan/bvh.c src/vulkan/commands.c src/vulkan/copy_rate.c src/vulkan/device.c src/vulkan/device_choice.c
         src/vulkan/frame.c src/vulkan/functions.c src/vulkan/handover.c
         src/vulkan/light.c src/vulkan/map.c src/vulkan/pipeline.c src/vulkan/points.c
         src/vulkan/pools.c src/vulkan/raster.c src/vulkan/read_back.c src/vulkan/renderer.c src/vulkan/sky.c src/vulkan/tables.c
         src/vulkan/textures.c)
    list(APPEND FEATURE_DEFINITIONS HELIO_WITH_VULKAN=1)
    list(APPEND FEATURE_LIBRARIES ${CMAKE_DL_LIBS})
else()
    list(APPEND SOURCES src/vulkan/device_absent.c)
endif()
