# Runs COMMAND and checks that it ends with STATUS and that its output matches OUTPUT.
separate_arguments(COMMAND)
execute_process(COMMAND ${COMMAND} RESULT_VARIABLE status OUTPUT_VARIABLE out ERROR_VARIABLE out)
if(NOT status EQUAL STATUS)
  message(FATAL_ERROR "${COMMAND}\nended with ${status}, not with ${STATUS}:\n${out}")
endif()
if(NOT out MATCHES "${OUTPUT}")
  message(FATAL_ERROR "${COMMAND}\nprinted no \"${OUTPUT}\":\n${out}")
endif()
