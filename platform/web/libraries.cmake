# What Debian has as compiled libraries for Linux alone, from the same source packages (GNOMON_WEB_FOLDER/src).
set(source "${GNOMON_WEB_FOLDER}/src")

# gnomon_web_library(NAME FOLDER SOURCES...): a static library of files below FOLDER, whose warnings are its authors' own.
function(gnomon_web_library name folder)
  list(TRANSFORM ARGN PREPEND "${source}/${folder}/")
  add_library(${name} STATIC ${ARGN})
  target_compile_options(${name} PRIVATE -w)
  target_include_directories(${name} SYSTEM PUBLIC "${PROJECT_SOURCE_DIR}/platform/web/include" "${source}/${folder}")
endfunction()

gnomon_web_library(libdeflate libdeflate lib/adler32.c lib/crc32.c lib/deflate_compress.c lib/deflate_decompress.c lib/utils.c
  lib/zlib_compress.c lib/zlib_decompress.c)

# SHA-256 and base64 alone.
set(headers "${PROJECT_BINARY_DIR}/web/include")
foreach(header nettle-types.h sha2.h base64.h)
  configure_file("${source}/nettle/${header}" "${headers}/nettle/${header}" COPYONLY)
endforeach()
gnomon_web_library(nettle nettle sha256.c sha256-compress-n.c write-be32.c base64-encode.c base64-decode.c)
target_include_directories(nettle SYSTEM INTERFACE "${headers}")

gnomon_web_library(web_zlib zlib adler32.c compress.c crc32.c deflate.c inffast.c inflate.c inftrees.c trees.c zutil.c)
configure_file("${source}/libpng1.6/scripts/pnglibconf.h.prebuilt" "${headers}/png/pnglibconf.h" COPYONLY)
gnomon_web_library(web_png libpng1.6 png.c pngerror.c pngget.c pngmem.c pngpread.c pngread.c pngrio.c pngrtran.c pngrutil.c pngset.c
  pngtrans.c pngwio.c pngwrite.c pngwtran.c pngwutil.c)
target_include_directories(web_png SYSTEM PUBLIC "${headers}/png")
target_link_libraries(web_png PUBLIC web_zlib)
add_library(PNG::PNG ALIAS web_png)

# What libjpeg-turbo's own CMakeLists.txt makes of its configuration, and compiles into libturbojpeg.
set(JPEG_LIB_VERSION 62)
set(VERSION 2.1.5)
set(LIBJPEG_TURBO_VERSION_NUMBER 2001005)
set(BITS_IN_JSAMPLE 8)
set(C_ARITH_CODING_SUPPORTED 1)
set(D_ARITH_CODING_SUPPORTED 1)
set(MEM_SRCDST_SUPPORTED 1)
set(INLINE inline)
set(SIZE_T 4)
configure_file("${source}/libjpeg-turbo/jconfig.h.in" "${headers}/jpeg/jconfig.h")
configure_file("${source}/libjpeg-turbo/jconfigint.h.in" "${headers}/jpeg/jconfigint.h")
configure_file("${source}/libjpeg-turbo/jversion.h.in" "${headers}/jpeg/jversion.h")
gnomon_web_library(web_jpeg libjpeg-turbo jcapimin.c jcapistd.c jccoefct.c jccolor.c jcdctmgr.c jchuff.c jcicc.c jcinit.c jcmainct.c
  jcmarker.c jcmaster.c jcomapi.c jcparam.c jcphuff.c jcprepct.c jcsample.c jctrans.c jdapimin.c jdapistd.c jdatadst.c jdatasrc.c
  jdcoefct.c jdcolor.c jddctmgr.c jdhuff.c jdicc.c jdinput.c jdmainct.c jdmarker.c jdmaster.c jdmerge.c jdphuff.c jdpostct.c
  jdsample.c jdtrans.c jerror.c jfdctflt.c jfdctfst.c jfdctint.c jidctflt.c jidctfst.c jidctint.c jidctred.c jquant1.c jquant2.c
  jutils.c jmemmgr.c jmemnobs.c jaricom.c jcarith.c jdarith.c jsimd_none.c turbojpeg.c transupp.c jdatadst-tj.c jdatasrc-tj.c
  rdbmp.c rdppm.c wrbmp.c wrppm.c)
target_compile_definitions(web_jpeg PRIVATE BMP_SUPPORTED PPM_SUPPORTED)
target_include_directories(web_jpeg SYSTEM PUBLIC "${headers}/jpeg")

gnomon_web_library(web_meshoptimizer meshoptimizer/src indexcodec.cpp vertexcodec.cpp vertexfilter.cpp)

# GMP's own small integers, of which gmpxx.h has what the tracer uses.
gnomon_web_library(mini_gmp gmp/mini-gmp mini-gmp.c)
