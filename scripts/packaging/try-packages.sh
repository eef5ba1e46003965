#!/usr/bin/env bash
# Use each of the installed packages on an otherwise empty Debian, as root, and remove the packages.
set -euo pipefail

export DEBIAN_FRONTEND=noninteractive

# the program, the manual and the cases
shoal --version
shoal check /usr/share/shoal/cases/diamond.yaml
shoal run /usr/share/shoal/cases/demo.yaml --set time.end=0.2 -q --force -o /tmp/demo.nc
shoal info /tmp/demo.nc
for page in man1/shoal.1 man5/shoal-case.5 man5/shoal-output.5; do [[ -s /usr/share/man/$page.gz ]]; done
cd /usr/share/doc/shoal-doc
grep -oh '](\(figures/\)\?[a-z_]*\.\(md\|png\|svg\))' ./*.md | tr -d ']()' | sort -u | while read -r link; do
    [[ -s $link ]] || { echo "shoal-doc lacks $link" >&2; exit 1; }
done

# the module
cd /tmp
python3 -c '
import shoal
with shoal.Run("/usr/share/shoal/cases/demo.yaml") as run:
    run.step()
    print("Python: nose at", run["x"][0, 0])'

# the library, shared
apt-get -q -y install --no-install-recommends gcc libc6-dev pkg-config
cat >client.c <<'C'
#include <shoal.h>
#include <stdio.h>
int main(void) {
    struct shoal *run;
    if (shoal_open(&run, "/usr/share/shoal/cases/demo.yaml", 0, NULL) < 0 || shoal_step(run) < 0) return 1;
    printf("C: t = %g s\n", shoal_time(run));
    shoal_close(run);
}
C
# shellcheck disable=SC2046 # several flags
gcc -o client client.c $(pkg-config --cflags --libs shoal)
./client

# nothing remains
apt-get -q -y purge shoal libshoal0 libshoal-dev python3-shoal shoal-doc
left=$(find /usr -path '*shoal*' -not -path '*/__pycache__*')
[[ -z $left ]] || { echo "left behind: $left" >&2; exit 1; }
echo 'the packages work'
