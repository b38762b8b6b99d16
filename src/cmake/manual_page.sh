#!/usr/bin/env bash
# manual_page.sh PROGRAM FILE: writes the manual page, which holds what `exactff help` and `exactff help COMMAND` print.
set -euo pipefail
program=$1 file=$2

# section TITLE WORD...: the help as it is, with the characters escaped that have a meaning in roff.
section() {
  printf '.SH %s\n.nf\n' "$1"
  shift
  "$program" help "$@" | sed "s/\\\\/\\\\e/g; s/-/\\\\-/g; s/\`/\\\\(ga/g; s/'/\\\\(aq/g; s/\\^/\\\\(ha/g; s/~/\\\\(ti/g; s/^\\./\\\\\\&./"
  printf '.fi\n'
}

{
  printf '.TH EXACTFF 1 "" "%s" "User commands"\n.nh\n.ad l\n' "$("$program" --version)"
  printf '.SH NAME\n%s\n' "$("$program" help | sed -n 's/^exactff: /exactff \\- /p')"
  section DESCRIPTION
  for command in $("$program" help | sed -n '/^Subcommands:/,$ s/^  \([a-z][a-z]*\) .*/\1/p'); do
    section "exactff $command" "$command"
  done
  cat << 'END'
.SH EXIT STATUS
.nf
0        Done.
1        A check failed.
2        Bad input; a message says what the problem is, why it matters and what to do.
3        A value is not as accurate or certified as asked; its bounds are still valid.
4        Internal error, or out of memory.
128 + N  Ended by signal N.
.fi
.SH SEE ALSO
.BR gnuplot (1),
which draws the figures of the reports if it is installed.
END
} > "$file"
