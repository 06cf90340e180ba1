# Runs at build time: writes OUTPUT, a header with the commit of the checkout at SOURCE, or with an
# empty text if there is no git or no checkout. An unchanged header keeps its modification time.
set(commit "")
if(EXISTS ${SOURCE}/.git)  # not a folder inside another checkout
  execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --exclude *
    OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
  if(failed)
    set(commit "")
  endif()
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "#define VOXDAG_COMMIT \"${commit}\"\n")
