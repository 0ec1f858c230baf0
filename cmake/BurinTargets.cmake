# SPDX-License-Identifier: Apache-2.0
# Compiler settings, and burin_library(): one CMake target a folder, linked one way.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  set(CMAKE_C_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()

# -ffp-contract=off: the same bits on machines with and without fused multiply-add (determinism is promised).
add_compile_options(-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion $<$<COMPILE_LANGUAGE:CXX>:-Wnon-virtual-dtor>
                    -Wno-missing-field-initializers -Werror -ffp-contract=off)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # False alarms of GCC 12 on std::string operator+ and on optional/variant in optimised builds (PR 105651, 105562).
  add_compile_options(-Wno-restrict -Wno-maybe-uninitialized)
endif()
if(BURIN_SANITIZE)
  add_compile_options(-fsanitize=${BURIN_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${BURIN_SANITIZE})
endif()
if(BURIN_FUZZ)
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()

if(BURIN_TESTS)
  enable_testing()
  find_package(GTest REQUIRED)
  include(GoogleTest)
endif()

# burin_library(NAME
#   SOURCES  a.cpp b.cpp            (none: an interface target of headers only)
#   DEPS     burin_base ...         burin targets that stand further left; they must exist already, so that a
#                                   cycle, or a link against the data flow, stops the configuration
#   PRIVATE  fmt::fmt ...           third-party libraries that stay out of the headers
#   TESTS    a_test.cpp ...         unit tests beside the source, one program a folder
#   TEST_LIBS ...)                  what only the tests link
function(burin_library NAME)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPS;PRIVATE;TESTS;TEST_LIBS" ${ARGN})
  foreach(dep IN LISTS ARG_DEPS)
    if(NOT TARGET ${dep})
      message(FATAL_ERROR "${NAME} links ${dep}, which does not stand left of it in the data flow")
    endif()
  endforeach()
  if(ARG_SOURCES)
    add_library(${NAME} STATIC ${ARG_SOURCES})
    target_include_directories(${NAME} PUBLIC ${CMAKE_SOURCE_DIR}/src)
    target_link_libraries(${NAME} PUBLIC ${ARG_DEPS} PRIVATE ${ARG_PRIVATE})
  else()
    add_library(${NAME} INTERFACE)
    target_include_directories(${NAME} INTERFACE ${CMAKE_SOURCE_DIR}/src)
    target_link_libraries(${NAME} INTERFACE ${ARG_DEPS})
  endif()
  if(BURIN_TESTS AND ARG_TESTS)
    burin_test(${NAME}_test SOURCES ${ARG_TESTS} LIBS ${NAME} ${ARG_PRIVATE} ${ARG_TEST_LIBS})
  endif()
endfunction()

# burin_test(NAME SOURCES ... LIBS ...): a GoogleTest program, its tests registered one by one.
function(burin_test NAME)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBS" ${ARGN})
  add_executable(${NAME} ${ARG_SOURCES})
  target_link_libraries(${NAME} PRIVATE ${ARG_LIBS} GTest::gtest GTest::gtest_main)
  target_compile_definitions(${NAME} PRIVATE BURIN_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
  gtest_discover_tests(${NAME} DISCOVERY_MODE PRE_TEST PROPERTIES TIMEOUT 300)
endfunction()

# burin_embed(TARGET HEADER_NAME FUNCTION files...): data files of the repository become part of the program, as
# a function burin::embedded::FUNCTION() that returns {name, text} pairs sorted by name.
function(burin_embed TARGET FUNCTION)
  set(out ${CMAKE_CURRENT_BINARY_DIR}/embedded_${FUNCTION}.cpp)
  set(files "")
  foreach(file IN LISTS ARGN)
    list(APPEND files ${CMAKE_SOURCE_DIR}/${file})
  endforeach()
  add_custom_command(
    OUTPUT ${out}
    COMMAND ${CMAKE_COMMAND} -DOUT=${out} -DFUNCTION=${FUNCTION} "-DFILES=${files}" -P
            ${CMAKE_SOURCE_DIR}/cmake/Embed.cmake
    DEPENDS ${files} ${CMAKE_SOURCE_DIR}/cmake/Embed.cmake
    VERBATIM)
  target_sources(${TARGET} PRIVATE ${out})
endfunction()
