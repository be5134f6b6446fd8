// SPDX-License-Identifier: MIT
//
// The list of findings of one file: grouped by code, the most severe first. Rows of a group are made when it is opened,
// some hundred at a time.

const MOST_ROWS = 10, MORE_ROWS = 500;
const words = {UV: 'UV', TAN: 'Tangent', POS: 'Position', NMAP: 'Normal map', MTL: 'MTL', W: 'w', NOT: 'not'};

// UV_MIRROR_SEAM: "UV mirror seam"
const titleOf = code => {
	const text = code.split('_').map((word, i) => words[word] || (i ? word.toLowerCase() : word[0] + word.slice(1).toLowerCase())).join(' ');
	return text[0].toUpperCase() + text.slice(1);
};

class Findings {
	constructor(onchoose) {
		this.onchoose = onchoose;
		this.filter = {error: true, warning: true, info: true, text: ''};
		this.rows = new Map(); // finding -> its button
		$('text').addEventListener('input', e => { this.filter.text = e.target.value.toLowerCase(); this.show(); });
	}

	load(file) {
		this.file = file;
		this.chosen = null;
		this.related = new Set();
		this.opened = new Map(); // code -> whether its group was opened or closed by hand
		$('levels').replaceChildren(...severities.map((severity, i) => {
			const n = file.findings.filter(x => x.severity === severity).length;
			const box = element('input', {type: 'checkbox', id: 'show-' + severity, checked: this.filter[severity], onchange: e => {
				this.filter[severity] = e.target.checked;
				this.show();
			}});
			return element('label', {class: 'chip ' + severity}, box, element('span', {}, plural(n, severity)));
		}));
		this.show();
	}

	isShown(x) {
		const {text} = this.filter;
		return this.filter[x.severity] && (!text || (x.message + ' ' + x.code + ' ' + titleOf(x.code) + ' ' + this.placeOf(x)).toLowerCase().includes(text));
	}

	placeOf(x) {
		return [data.diff && (x.known ? 'in both' : x.file.number ? 'new' : 'gone'), x.where, x.known && !data.diff ? 'known' : null]
			.filter(part => part).join(' · ');
	}

	row(x) {
		const mark = x.seam !== null ? String(x.seam) : '';
		const button = element('button', {type: 'button', class: 'finding', id: 'finding-' + x.number, 'data-finding': x.number,
			onclick: () => this.onchoose(x)},
			mark ? element('span', {class: 'mark', title: 'Seam ' + mark}, mark) : null,
			element('span', {class: 'message'}, x.message), element('span', {class: 'place'}, this.placeOf(x)));
		this.rows.set(x, button);
		this.markRow(x);
		return element('li', {}, button);
	}

	markRow(x) {
		const button = this.rows.get(x);
		if (!button) return;
		button.classList.toggle('related', this.related.has(x));
		if (x === this.chosen) button.setAttribute('aria-current', 'true');
		else button.removeAttribute('aria-current');
	}

	fill(list, items, shown) {
		list.replaceChildren(...items.slice(0, shown).map(x => this.row(x)));
		if (items.length > shown)
			list.append(element('li', {}, element('button', {type: 'button', class: 'more', onclick: () => this.fill(list, items, shown + MORE_ROWS)},
				items.length - shown <= MORE_ROWS ? 'Show ' + count(items.length - shown) + ' more' : 'Show ' + count(MORE_ROWS) + ' more of ' + count(items.length - shown))));
	}

	group(code, items, opened) {
		const row = data.codes[code] || {}, severity = severities[Math.min(...items.map(x => severities.indexOf(x.severity)))];
		const list = element('ol', {});
		const group = element('details', {class: 'group ' + severity, 'data-code': code, open: opened},
			element('summary', {onclick: () => this.opened.set(code, !group.open)}, element('span', {class: 'dot', title: severity}), element('span', {class: 'name'}, titleOf(code)),
				element('span', {class: 'number'}, count(items.length)), element('code', {}, code)),
			element('p', {class: 'remedy'}, row.remedy || ''),
			element('details', {class: 'about'}, element('summary', {}, 'What it means'), row.meaning || ''), list);
		const command = items.find(x => x.repair && !(data.diff && !x.file.number))?.repair; // the old version stays
		if (command) group.insertBefore(this.command(command), group.querySelector('.about'));
		const needed = items.indexOf(this.chosen) + 1;
		const fill = () => { if (group.open && !list.firstChild) this.fill(list, items, Math.max(MOST_ROWS, needed)); };
		group.addEventListener('toggle', fill);
		fill();
		return group;
	}

	// If the clipboard is out of reach, the command is marked, to be copied by hand.
	command(text) {
		const code = element('code', {}, text), copy = element('button', {type: 'button', 'aria-label': 'Copy the command that repairs it', onclick: async () => {
			try {
				await navigator.clipboard.writeText(text);
				copy.textContent = 'Copied';
			} catch {
				getSelection().selectAllChildren(code);
			}
		}}, 'Copy');
		return element('p', {class: 'command'}, code, copy);
	}

	show() {
		const shown = this.file.findings.filter(x => this.isShown(x)), groups = new Map();
		for (const x of shown) groups.has(x.code) ? groups.get(x.code).push(x) : groups.set(x.code, [x]);
		const worst = items => Math.min(...items.map(x => severities.indexOf(x.severity)));
		const order = [...groups].sort((a, b) => worst(a[1]) - worst(b[1])); // else as the report has them: what matters more first
		this.rows.clear();
		const opened = code => this.opened.get(code) ?? (order.length <= 2 || shown.length <= 12 || order[0][0] === code);
		$('groups').replaceChildren(...order.map(([code, items]) => this.group(code, items, opened(code) || items.includes(this.chosen))));
		const all = this.file.findings.length;
		if (!all) $('groups').append(element('p', {class: this.file.failure ? 'empty' : 'empty good'}, this.file.failure ? '' : data.diff ? unchanged : 'Nothing to report. This file is as it should be.'));
		else if (!shown.length) $('groups').append(element('p', {class: 'empty'}, 'No finding passes the filter.'));
		$('shown').textContent = !all ? '' : (shown.length === all ? plural(all, 'finding') : count(shown.length) + ' of ' + plural(all, 'finding')) +
			(data.left_out ? '; ' + plural(data.left_out, 'more is', 'more are') + ' not on this page' : '');
	}

	// Marks one as chosen, others as belonging to what is chosen in a view.
	choose(finding, related) {
		const before = [this.chosen, ...this.related];
		this.chosen = finding;
		this.related = new Set(related);
		const target = finding || related[0];
		if (target && !this.rows.has(target)) {
			if (!this.isShown(target)) { Object.assign(this.filter, {text: ''}, {[target.severity]: true}); $('text').value = ''; }
			this.opened.set(target.code, true);
			const chosen = this.chosen;
			this.chosen = target; // so that its row is made
			this.show();
			this.chosen = chosen;
		}
		for (const x of [...before, this.chosen, ...this.related]) if (x) this.markRow(x);
		if (target) this.rows.get(target)?.scrollIntoView({block: 'nearest'});
	}
}
