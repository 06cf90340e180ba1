# The packages of a build for browsers. Header-only libraries are those of Debian. The others are compiled from
# the archives that Debian 12 built its packages of, so that pictures and archives decode to the same bytes as
# in the native program. OpenEXR, assimp, Embree, OpenVDB, MPI and CUDA are left out.
enable_language(C)
include(FetchContent)
set(FETCHCONTENT_QUIET ON)
if(POLICY CMP0135)
  cmake_policy(SET CMP0135 NEW)  # extracted files get the time of extraction
endif()

# debian_source(NAME PATH HASH) downloads an archive from Debian's pool and sets NAME to its folder.
function(debian_source name path hash)
  FetchContent_Declare(${name} URL http://deb.debian.org/debian/pool/main/${path} URL_HASH SHA256=${hash})
  FetchContent_Populate(${name})
  set(${name} ${${name}_SOURCE_DIR} PARENT_SCOPE)
endfunction()

# c_library(TARGET ALIAS FOLDER INCLUDES... SOURCES file...) compiles sources of another project, without warnings.
function(c_library target alias folder)
  cmake_parse_arguments(ARG "" "" "INCLUDES;SOURCES" ${ARGN})
  list(TRANSFORM ARG_SOURCES PREPEND ${folder}/)
  add_library(${target} STATIC EXCLUDE_FROM_ALL ${ARG_SOURCES})
  add_library(${alias} ALIAS ${target})
  target_include_directories(${target} SYSTEM PUBLIC ${ARG_INCLUDES})
  target_compile_options(${target} PRIVATE -w -Os)
  set_target_properties(${target} PROPERTIES UNITY_BUILD OFF)
endfunction()

# Headers of Debian. The folder /usr/include itself has those of the wrong C library.
set(headers ${PROJECT_BINARY_DIR}/headers)
file(MAKE_DIRECTORY ${headers})
foreach(header fmt nlohmann fast_float hwy stb xxhash.h CLI)
  if(NOT EXISTS /usr/include/${header})
    message(FATAL_ERROR "/usr/include/${header} does not exist: scripts/packages.sh names the packages")
  endif()
  file(CREATE_LINK /usr/include/${header} ${headers}/${header} SYMBOLIC)
endforeach()
include_directories(SYSTEM ${headers})
foreach(target fmt::fmt nlohmann_json::nlohmann_json FastFloat::fast_float hwy::hwy CLI11::CLI11)
  add_library(${target} INTERFACE IMPORTED)
endforeach()
target_compile_definitions(fmt::fmt INTERFACE FMT_HEADER_ONLY)
target_compile_definitions(hwy::hwy INTERFACE HWY_COMPILE_ONLY_STATIC)
add_library(Threads::Threads INTERFACE IMPORTED)

debian_source(zlib z/zlib/zlib_1.2.13.dfsg.orig.tar.bz2 71feb7947e3c00ef125f83b79a4e529bde31171e5babe48b391f06758d1ab0a1)
c_library(zlib ZLIB::ZLIB ${zlib} INCLUDES ${zlib} SOURCES
  adler32.c compress.c crc32.c deflate.c inffast.c inflate.c inftrees.c trees.c uncompr.c zutil.c gzclose.c gzlib.c gzread.c gzwrite.c)
target_compile_definitions(zlib PRIVATE HAVE_UNISTD_H)
c_library(minizip minizip::minizip ${zlib}/contrib/minizip INCLUDES ${zlib}/contrib SOURCES ioapi.c unzip.c zip.c)
target_compile_definitions(minizip PRIVATE NOCRYPT NOUNCRYPT IOAPI_NO_64)
target_link_libraries(minizip PUBLIC ZLIB::ZLIB)

debian_source(png libp/libpng1.6/libpng1.6_1.6.39.orig.tar.gz a00e9d2f2f664186e4202db9299397f851aea71b36a35e74910b8820e380d441)
configure_file(${png}/scripts/pnglibconf.h.prebuilt ${PROJECT_BINARY_DIR}/png/pnglibconf.h COPYONLY)
c_library(png PNG::PNG ${png} INCLUDES ${png} ${PROJECT_BINARY_DIR}/png SOURCES
  png.c pngerror.c pngget.c pngmem.c pngpread.c pngread.c pngrio.c pngrtran.c pngrutil.c pngset.c pngtrans.c pngwio.c
  pngwrite.c pngwtran.c pngwutil.c)
target_link_libraries(png PUBLIC ZLIB::ZLIB)

debian_source(jpeg libj/libjpeg-turbo/libjpeg-turbo_2.1.5.orig.tar.gz 254f3642b04e309fee775123133c6464181addc150499561020312ec61c1bf7c)
set(JPEG_LIB_VERSION 62)
set(VERSION 2.1.5)
set(LIBJPEG_TURBO_VERSION_NUMBER 2001005)
set(BITS_IN_JSAMPLE 8)
set(C_ARITH_CODING_SUPPORTED 1)
set(D_ARITH_CODING_SUPPORTED 1)
set(MEM_SRCDST_SUPPORTED 1)
set(INLINE inline)
set(SIZE_T 4)
configure_file(${jpeg}/jconfig.h.in ${PROJECT_BINARY_DIR}/jpeg/jconfig.h)
configure_file(${jpeg}/jconfigint.h.in ${PROJECT_BINARY_DIR}/jpeg/jconfigint.h)
configure_file(${jpeg}/jversion.h.in ${PROJECT_BINARY_DIR}/jpeg/jversion.h)
c_library(jpeg JPEG::JPEG ${jpeg} INCLUDES ${jpeg} ${PROJECT_BINARY_DIR}/jpeg SOURCES
  jcapimin.c jcapistd.c jccoefct.c jccolor.c jcdctmgr.c jchuff.c jcicc.c jcinit.c jcmainct.c jcmarker.c jcmaster.c
  jcomapi.c jcparam.c jcphuff.c jcprepct.c jcsample.c jctrans.c jdapimin.c jdapistd.c jdatadst.c jdatasrc.c jdcoefct.c
  jdcolor.c jddctmgr.c jdhuff.c jdicc.c jdinput.c jdmainct.c jdmarker.c jdmaster.c jdmerge.c jdphuff.c jdpostct.c
  jdsample.c jdtrans.c jerror.c jfdctflt.c jfdctfst.c jfdctint.c jidctflt.c jidctfst.c jidctint.c jidctred.c jquant1.c
  jquant2.c jutils.c jmemmgr.c jmemnobs.c jaricom.c jcarith.c jdarith.c jsimd_none.c)

debian_source(webp libw/libwebp/libwebp_1.2.4.orig.tar.gz 7bf5a8a28cc69bcfa8cb214f2c3095703c6b73ac5fba4d5480c205331d9494df)
# Tests alone encode.
file(GLOB webp_sources RELATIVE ${webp} ${webp}/src/dec/*.c ${webp}/src/enc/*.c ${webp}/src/dsp/*.c ${webp}/src/utils/*.c
  ${webp}/sharpyuv/*.c)
list(FILTER webp_sources EXCLUDE REGEX "(dsp|sharpyuv)/.*_(mips32|mips_dsp_r2|msa|neon|sse2|sse41)\\.c")
if(NOT VOXDAG_BUILD_TESTS)
  list(FILTER webp_sources EXCLUDE REGEX "sharpyuv/|enc/|dsp/(cost|enc|lossless_enc|ssim)\\.c|encode")
endif()
c_library(webp WebP::webp ${webp} INCLUDES ${webp}/src ${webp} SOURCES ${webp_sources})

debian_source(expat e/expat/expat_2.5.0.orig.tar.gz ab00ee05c7067fd10a35c5d2a4922ebba746ddd50ff83b79c828da17bbdf1757)
c_library(expat EXPAT::EXPAT ${expat}/expat/lib INCLUDES ${expat}/expat/lib SOURCES xmlparse.c xmlrole.c xmltok.c)
file(WRITE ${PROJECT_BINARY_DIR}/expat/expat_config.h "")
target_include_directories(expat PRIVATE ${PROJECT_BINARY_DIR}/expat)
target_compile_definitions(expat PRIVATE XML_DTD XML_NS XML_CONTEXT_BYTES=1024 XML_DEV_URANDOM BYTEORDER=1234
  HAVE_UNISTD_H HAVE_STDINT_H)

debian_source(zstd libz/libzstd/libzstd_1.5.4+dfsg2.orig.tar.xz 8cf4bbb65e77ec348d052c8d6230eba66d435bddf64c8b5be2fcb16880c19953)
file(GLOB zstd_sources RELATIVE ${zstd}/lib ${zstd}/lib/common/*.c ${zstd}/lib/decompress/*.c)
c_library(zstd zstd::zstd ${zstd}/lib INCLUDES ${zstd}/lib SOURCES ${zstd_sources})

debian_source(meshopt m/meshoptimizer/meshoptimizer_0.18+dfsg.orig.tar.xz 881ea2cc687f1fef5ce70484e0ca6504e13856dd856677749f3763bc685956d3)
c_library(meshopt meshoptimizer::meshoptimizer ${meshopt}/src INCLUDES ${meshopt}/src SOURCES
  indexcodec.cpp vertexcodec.cpp vertexfilter.cpp)

debian_source(draco d/draco/draco_1.5.5+dfsg.orig.tar.xz 0d4ff5b218a2f9d836c6f44202918402591407b5f59a5103ec288c5600ab087f)
file(GLOB_RECURSE draco_sources RELATIVE ${draco}/src ${draco}/src/draco/*.cc)
list(FILTER draco_sources EXCLUDE REGEX "test|encod|/io/|tools|maya|unity|javascript|animation|scene|texture|material")
file(WRITE ${PROJECT_BINARY_DIR}/draco/draco/draco_features.h
  "#pragma once\n#define DRACO_MESH_COMPRESSION_SUPPORTED\n#define DRACO_NORMAL_ENCODING_SUPPORTED\n"
  "#define DRACO_STANDARD_EDGEBREAKER_SUPPORTED\n#define DRACO_PREDICTIVE_EDGEBREAKER_SUPPORTED\n")
c_library(draco draco::draco ${draco}/src INCLUDES ${draco}/src ${PROJECT_BINARY_DIR}/draco SOURCES ${draco_sources})
