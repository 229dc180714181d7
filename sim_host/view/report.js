// Shows of the failures those that are asked for.
'use strict';

(() => {
  const filters = [...document.querySelectorAll('[data-filter]')];
  const rows = [...document.querySelectorAll('#failures tbody tr')];
  const filter = () => {
    let shown = 0;
    for (const row of rows) {
      row.hidden = filters.some((one) => one.value && row.dataset[one.dataset.filter] !== one.value);
      shown += row.hidden ? 0 : 1;
    }
    const count = document.getElementById('shown');
    if (count) count.textContent = `${shown} of ${rows.length} shown`;
  };
  for (const one of filters) one.addEventListener('change', filter);
  filter();
})();
