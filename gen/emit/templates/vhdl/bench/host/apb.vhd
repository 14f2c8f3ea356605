{% if part == "signals" %}
    -- The bus: an APB3 master. It changes its signals at falling edges of the clock.
    signal psel, penable, pwrite : std_logic := '0';
    signal paddr : std_logic_vector(12 downto 0) := (others => '0');
    signal pwdata, prdata : word_t := (others => '0');
    signal pready, pslverr : std_logic;
{% elif part == "procedures" %}
        -- A word; the card refuses an offset that is no multiple of 4.
        procedure transfer (write : boolean; address : natural; value : word_t; offset : natural := 0) is
        begin
            wait until falling_edge(clk);
            psel <= '1';
            pwrite <= bit_of(write);
            paddr <= bits_of(4 * address + offset, 13);
            pwdata <= value;
            wait until falling_edge(clk);
            penable <= '1';
            for n in 1 to ACCESS_CYCLES_MAX loop
                wait until rising_edge(clk);
                exit when pready = '1';
            end loop;
            check("pready", pready, '1');
            check("pslverr", pslverr, bit_of(offset /= 0));
            answer := prdata;
            wait until falling_edge(clk);
            psel <= '0';
            penable <= '0';
        end procedure;
{% elif part == "steps" %}
        tell("bus: addresses that are no word");
        for offset in 1 to 3 loop
            transfer(false, CARD_ID, x"00000000", offset);
            transfer(true, CARD_CONFIG_TRIGGER_SOURCES, x"FFFFFFFF", offset);
        end loop;
        read_words(CARD_CONFIG_TRIGGER_SOURCES, 1);
        check("trigger_sources after a write that was refused", words(0), placed(1, TRIGGER_SOURCES_PIN_F));

{% endif %}
