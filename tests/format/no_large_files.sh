#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Names the files among its arguments that are larger than 1 MB and fails if there are any. Files in
# assets/ are exempt, since the program needs them.
status=0
for file in "$@"; do
  [[ $file == assets/* || ! -f $file ]] && continue
  size=$(stat -c %s -- "$file")
  if (( size > 1000000 )); then
    echo "$file: has $size bytes; data of over 1 MB stays out of the repository"
    status=1
  fi
done
exit $status
