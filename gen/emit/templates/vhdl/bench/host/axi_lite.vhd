{% if part == "signals" %}
    -- The bus: an AXI4-Lite master. It changes its signals at falling edges of the clock.
    signal awvalid, wvalid, bready, arvalid, rready : std_logic := '0';
    signal awaddr, araddr : std_logic_vector(12 downto 0) := (others => '0');
    signal wdata, rdata : word_t := (others => '0');
    signal wstrb : std_logic_vector(3 downto 0) := "1111";
    signal awready, wready, bvalid, arready, rvalid : std_logic;
    signal bresp, rresp : std_logic_vector(1 downto 0);
{% elif part == "procedures" %}
        -- A word; the card refuses to write a part of one. The master takes the answer so many cycles after it has come.
        procedure transfer (write : boolean; address : natural; value : word_t;
                            bytes : std_logic_vector(3 downto 0) := "1111"; stalled : natural := 0) is
            variable aw, w, ar, is_answered : boolean := false;
            variable first : word_t;
        begin
            wait until falling_edge(clk);
            -- The direction that is not meant has another address.
            awaddr <= bits_of(4 * address, 13);
            araddr <= bits_of(4 * address, 13);
            if write then
                araddr <= not bits_of(4 * address, 13);
            else
                awaddr <= not bits_of(4 * address, 13);
            end if;
            wdata <= value;
            wstrb <= bytes;
            awvalid <= bit_of(write);
            wvalid <= bit_of(write);
            arvalid <= bit_of(not write);
            bready <= bit_of(write and stalled = 0);
            rready <= bit_of(not write and stalled = 0);
            for n in 1 to ACCESS_CYCLES_MAX loop
                wait until rising_edge(clk);
                aw := awvalid = '1' and awready = '1';
                w := wvalid = '1' and wready = '1';
                ar := arvalid = '1' and arready = '1';
                is_answered := (write and bvalid = '1') or (not write and rvalid = '1');
                exit when is_answered;
                wait until falling_edge(clk);
                if aw then
                    awvalid <= '0';
                end if;
                if w then
                    wvalid <= '0';
                end if;
                if ar then
                    arvalid <= '0';
                end if;
            end loop;
            first := rdata;
            for n in 1 to stalled loop
                wait until falling_edge(clk);
                awvalid <= '0';
                wvalid <= '0';
                arvalid <= '0';
                bready <= bit_of(write and n = stalled);
                rready <= bit_of(not write and n = stalled);
                wait until rising_edge(clk);
                is_answered := (write and bvalid = '1') or (not write and rvalid = '1');
                if not write then
                    check("rdata while the master waits", rdata, first);
                end if;
            end loop;
            if not is_answered then
                complain("no answer on the bus");
            elsif write then
                if bytes = "1111" then
                    check("bresp", bresp, "00");
                else
                    check("bresp of a write that is refused", bresp, "10");
                end if;
            else
                check("rresp", rresp, "00");
            end if;
            answer := rdata;
            wait until falling_edge(clk);
            awvalid <= '0';
            wvalid <= '0';
            arvalid <= '0';
            bready <= '0';
            rready <= '0';
            wait until rising_edge(clk);
            if bvalid = '1' or rvalid = '1' then
                complain("a second answer on the bus");
            end if;
        end procedure;
{% elif part == "steps" %}
        tell("bus: writes of a part of a word, answers that the master takes late");
        for byte in 0 to 3 loop
            transfer(true, CARD_CONFIG_TRIGGER_SOURCES, x"FFFFFFFF", bits_of(2 ** byte, 4));
        end loop;
        read_words(CARD_CONFIG_TRIGGER_SOURCES, 1);
        check("trigger_sources after writes that were refused", words(0), placed(1, TRIGGER_SOURCES_PIN_F));
        for stalled in 1 to 5 loop
            transfer(true, CARD_CONFIG_HOLD, placed(1000 + stalled, HOLD_SCRATCH_F), stalled => stalled);
            wait for SETTLE;
            transfer(false, CARD_CONFIG_HOLD, x"00000000", stalled => stalled);
            check("word that was written", answer, placed(1000 + stalled, HOLD_SCRATCH_F));
        end loop;
        write_word(CARD_CONFIG_HOLD, x"00000000");

{% endif %}
