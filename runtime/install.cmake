# Installed: the C and C++ headers, the libraries with and without GL, find_package(Opaline) and pkg-config.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

target_include_directories(opaline_runtime INTERFACE
    $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
set(OPALINE_INSTALLED opaline_runtime opaline_opal)
if(OPALINE_BUILD_SHARED)
    list(APPEND OPALINE_INSTALLED opaline_shared)
endif()
if(OPALINE_BUILD_GL)
    list(APPEND OPALINE_INSTALLED opaline_embed_gl)
    if(OPALINE_BUILD_SHARED)
        list(APPEND OPALINE_INSTALLED opaline_gl_shared)
    endif()
    install(FILES opaline_gl.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
    foreach(OPALINE_GLSL_FILE surface gloss images volumes layer)
        list(APPEND OPALINE_GLSL_FILES ${CMAKE_CURRENT_BINARY_DIR}/embed_gl/shaders/generated/opaline_${OPALINE_GLSL_FILE}.glsl)
    endforeach()
    install(FILES ${OPALINE_GLSL_FILES} DESTINATION ${CMAKE_INSTALL_DATADIR}/opaline/glsl)
endif()
install(TARGETS ${OPALINE_INSTALLED} EXPORT OpalineTargets
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(FILES opaline.h opaline.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})

set(OPALINE_CONFIG_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/Opaline)
install(EXPORT OpalineTargets NAMESPACE Opaline:: DESTINATION ${OPALINE_CONFIG_DIR})
set(OPALINE_GLSL_DIR ${CMAKE_INSTALL_DATADIR}/opaline/glsl)
configure_package_config_file(cmake/OpalineConfig.cmake.in OpalineConfig.cmake PATH_VARS OPALINE_GLSL_DIR
    INSTALL_DESTINATION ${OPALINE_CONFIG_DIR})
write_basic_package_version_file(OpalineConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/OpalineConfig.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/OpalineConfigVersion.cmake
        DESTINATION ${OPALINE_CONFIG_DIR})
if(OPALINE_BUILD_SHARED)
    cmake_path(RELATIVE_PATH CMAKE_INSTALL_PREFIX
               BASE_DIRECTORY ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig
               OUTPUT_VARIABLE OPALINE_PC_TO_PREFIX)
    set(OPALINE_PC_LIBRARIES opaline)
    if(OPALINE_BUILD_GL)
        list(APPEND OPALINE_PC_LIBRARIES opaline-gl)
    endif()
    foreach(OPALINE_PC_NAME IN LISTS OPALINE_PC_LIBRARIES)
        configure_file(cmake/opaline.pc.in ${OPALINE_PC_NAME}.pc @ONLY)
        install(FILES ${CMAKE_CURRENT_BINARY_DIR}/${OPALINE_PC_NAME}.pc
                DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
    endforeach()
endif()
