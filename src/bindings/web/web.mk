# SPDX-License-Identifier: MIT
#
# make web: the page in build/web, static files for any web server. Markup, style and script of the report are those that
# the tool has in itself, in the order of page_assets.c.

web_dir := src/bindings/web
web_page := src/report/render/page
web_scripts := $(addprefix $(web_page)/,$(shell grep -o '[a-z]*\.js' src/report/render/page_assets.c))
web_files := index.html app.css app.js files.js zip.js worker.js run.js report.html report.css report.js tool.js tool.wasm head.obj

.PHONY: web
web: wasm-tool
	@$(MAKE) --no-print-directory build/web/sw.js

# A script for workers that import.
build/web/tool.js: build/web-tool/nmtan-tool.js
	@mkdir -p $(@D)
	{ cat $< && echo 'export default createNmtan;'; } >$@.part && mv $@.part $@
build/web/tool.wasm: build/web-tool/nmtan-tool.wasm
build/web/run.js: build/web-tool/run.js

$(addprefix build/web/,index.html app.css app.js files.js zip.js worker.js): build/web/%: $(web_dir)/%
build/web/report.css: $(web_page)/page.css
build/web/head.obj: data/head.obj
$(addprefix build/web/,index.html app.css app.js files.js zip.js worker.js report.css head.obj tool.wasm run.js):
	@mkdir -p $(@D)
	cp $< $@

build/web/report.js: $(web_scripts) src/report/render/page_assets.c
	@mkdir -p $(@D)
	{ printf "'use strict';\n(() => {\n" && cat $(web_scripts) && printf '})();\n'; } >$@.part && mv $@.part $@

# Not of $^, which has this file too: see below.
build/web/report.html: $(web_dir)/report.html $(web_page)/page.html
	@mkdir -p $(@D)
	{ cat $(web_dir)/report.html $(web_page)/page.html && printf '</body>\n</html>\n'; } >$@.part && mv $@.part $@

# A change of these rules makes their targets again.
$(addprefix build/web/,$(web_files)): $(web_dir)/web.mk

# Another version is another cache: its name is of the bytes.
build/web/sw.js: $(web_dir)/sw.js $(addprefix build/web/,$(web_files))
	version=$$(cat $^ | sha256sum | cut -c 1-16) && \
		sed "s/@VERSION@/$$version/; s,@FILES@,./ $(web_files)," $< >$@.part && mv $@.part $@
