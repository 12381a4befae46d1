#!/bin/sh
# SPDX-License-Identifier: MIT
# Opens the page of a small study in a headless browser: it says nothing on its console, and every picture is there.
#
# usage: check_page.sh HELIOSTAT
# Where there is no chromium it says so and passes: test_study looks at the page as XML and decodes its pictures.
set -eu
program=${1:?usage: check_page.sh HELIOSTAT}
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)
if [ -z "$browser" ]; then
    echo 'There is no chromium here: the page is not opened in a browser, only read by test_study.'
    exit 0
fi

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
cat > mesh.obj <<'MESH'
v 1 1 1
v -1 -1 1
v -1 1 -1
v 1 -1 -1
f 1 3 2
f 1 4 2
f 1 4 3
f 2 3 4
MESH
"$program" study --mesh mesh.obj --size 64x36 --env-size 16 --envs constant:1,1,1 --materials 'diffuse:0.8;ggx' \
    --spp 4,16 --strategies face,brdf --reference-spp 64 --out study --quiet

# The page itself has no script: that which looks at it is added to a copy. Text that leads out of the frame, or is
# drawn over other text, is for people to see; this sees what is missing.
cat > look <<'SCRIPT'
<script>
window.addEventListener("load", function () {
    var pictures = Array.from(document.images), text = document.querySelectorAll("svg text");
    var loaded = pictures.filter(function (p) { return p.complete && p.naturalWidth > 0; });
    var drawn = Array.from(text).filter(function (t) { return t.getBBox().width > 0; });
    document.body.setAttribute("data-seen", loaded.length + " of " + pictures.length + " pictures, " + drawn.length +
        " of " + text.length + " words, " + performance.getEntriesByType("resource").filter(function (r) {
            return !r.name.startsWith("data:"); }).length + " from elsewhere");
});
</script>
SCRIPT
sed '/<\/body>/{
r look
N
}' study/study.html > page.html
timeout 120 "$browser" --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --user-data-dir="$folder/profile" \
    --enable-logging=stderr --virtual-time-budget=10000 --dump-dom "file://$folder/page.html" > dom 2> console

fail() {
    echo "$1" >&2
    exit 1
}
! grep -i 'CONSOLE' console || fail 'the page says that on its console'
seen=$(grep -o 'data-seen="[^"]*"' dom) || fail 'the page was not loaded'
echo "$seen"
pictures=$(grep -o '<img ' study/study.html | wc -l)
words=$(grep -o '<text ' study/study.html | wc -l)
has_png=$("$program" info | grep -c 'PNG *yes' || true)
[ "$has_png" -eq 0 ] || [ "$pictures" -eq 10 ] || fail "there are $pictures pictures in place of 10"
[ "$seen" = "data-seen=\"$pictures of $pictures pictures, $words of $words words, 0 from elsewhere\"" ] ||
    fail 'something of the page is missing'
