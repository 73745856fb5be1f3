# What makes a build from nothing fast: the headers that most sources include are parsed once, and the sources of a room are
# compiled forty at a time, so that helpers in anonymous namespaces have names of their own within a room.

# Every library and program defined in DIRECTORY and below it, in the list OUT.
function(opaline_targets_below directory out)
    get_property(targets DIRECTORY ${directory} PROPERTY BUILDSYSTEM_TARGETS)
    get_property(folders DIRECTORY ${directory} PROPERTY SUBDIRECTORIES)
    foreach(folder IN LISTS folders)
        opaline_targets_below(${folder} below)
        list(APPEND targets ${below})
    endforeach()
    set(${out} ${targets} PARENT_SCOPE)
endfunction()

# Compiles the sources of TARGET together, with the precompiled headers of the target FROM, whose flags must be the same.
function(opaline_build_fast target from)
    if(OPALINE_FAST_BUILD)
        set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 40)
        target_precompile_headers(${target} REUSE_FROM ${from})
    endif()
endfunction()

# A target that holds precompiled headers and nothing else.
function(opaline_precompiled name)
    cmake_parse_arguments(ARG "" "" "HEADERS;LIBRARIES" ${ARGN})
    if(OPALINE_FAST_BUILD)
        file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp CONTENT "")
        add_library(${name} OBJECT EXCLUDE_FROM_ALL ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
        target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
        target_link_libraries(${name} PRIVATE ${ARG_LIBRARIES} opaline_warnings)
        target_precompile_headers(${name} PRIVATE ${ARG_HEADERS})
    endif()
endfunction()

# Sources of the static library TARGET that are compiled with OPTIONS: in a library of objects, as a source with options of its
# own would be left out of its target's unity build.
function(opaline_compile_with target name options)
    add_library(${target}_${name} OBJECT ${ARGN})
    target_include_directories(${target}_${name} PRIVATE ${PROJECT_SOURCE_DIR})
    target_compile_options(${target}_${name} PRIVATE -ffunction-sections -fdata-sections ${options})
    target_link_libraries(${target}_${name} PRIVATE opaline_warnings)
    set_target_properties(${target}_${name} PROPERTIES
        POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
    if(OPALINE_FAST_BUILD)
        set_target_properties(${target}_${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 40)
    endif()
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:${target}_${name}>)
endfunction()
